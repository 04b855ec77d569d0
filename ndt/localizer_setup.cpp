#include "ndt/localizer.hpp"

namespace landfix::ndt {

Localizer::Localizer(const VoxelMap& map, const LocalizerSettings& settings, const Pose& initial_pose)
    : map_(map), settings_(settings), matcher_(settings.matcher) {
  last_.pose = initial_pose;
}

}  // namespace landfix::ndt
