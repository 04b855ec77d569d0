// Where something that knows less than the map, such as a satellite receiver, says that the vehicle is.
#pragma once

#include <optional>

#include <Eigen/Core>

namespace landfix::ndt {

/// In the frame `map`.
struct PoseGuess {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  std::optional<double> height_m{};  ///< tells one level of the ground from another
  std::optional<double> yaw_rad{};   ///< nothing: any
  double within_m = 3.0;             ///< the vehicle is no farther away than this

  static constexpr double kHeightWithin_m = 3.0;  ///< one level of a road is farther from the next
  static constexpr double kYawWithin_rad = 0.1;
};

}  // namespace landfix::ndt
