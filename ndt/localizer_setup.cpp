#include "ndt/localizer.hpp"

namespace landfix::ndt {

Localizer::Localizer(const VoxelMap& map, const LocalizerSettings& settings, const Pose& initial_pose)
    : map_(map),
      settings_(settings),
      matcher_(settings.matcher),
      recovery_({.good_likelihood = settings.gates.good_likelihood,
                 .good_matched_share = settings.gates.good_matched_share}) {
  last_.pose = initial_pose;
}

}  // namespace landfix::ndt
