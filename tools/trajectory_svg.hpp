// A picture of a drive: the trajectory over the map, seen from above, coloured by its error.
#pragma once

#include <span>
#include <string>

#include <Eigen/Core>

#include "platform/trajectory.hpp"

namespace landfix::tools {

/// An SVG whose map takes at most 1.5 MB. `map_points_m`: frame `map`, any number, also none. With `truth` it
/// shows the errors, on the line and over the distance; without, the line alone.
[[nodiscard]] std::string trajectory_svg(std::span<const Eigen::Vector3f> map_points_m,
                                         std::span<const platform::StampedPose> trajectory,
                                         std::span<const platform::StampedPose> truth = {});

}  // namespace landfix::tools
