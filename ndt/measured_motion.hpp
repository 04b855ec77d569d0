// What another sensor than the LiDAR, such as the wheels, says of the vehicle's motion.
#pragma once

#include <optional>

#include "ndt/motion.hpp"
#include "ndt/pose.hpp"

namespace landfix::ndt {

/// From an earlier time to a later one.
struct MeasuredMotion {
  Pose change = Pose::Identity();        ///< vehicle at the earlier time <- vehicle at the later one
  Velocity velocity = Velocity::Zero();  ///< at the later time
  /// Standard deviation of the speed, an error that lasts; nothing where the speed was not measured.
  std::optional<double> sigma_mps{};
};

}  // namespace landfix::ndt
