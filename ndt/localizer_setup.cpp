#include "ndt/localizer.hpp"

namespace landfix::ndt {

Localizer::Localizer(const VoxelMap& map, const LocalizerSettings& settings,
                     const std::optional<Pose>& initial_pose)
    : map_(map),
      settings_(settings),
      matcher_(settings.matcher),
      recovery_({.gates = settings.gates}),
      has_pose_(initial_pose.has_value()) {
  last_.pose = initial_pose.value_or(Pose::Identity());
}

}  // namespace landfix::ndt
