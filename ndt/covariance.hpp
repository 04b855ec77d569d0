// How uncertain a matched pose is.
#pragma once

#include "ndt/objective.hpp"
#include "ndt/pose.hpp"

namespace landfix::ndt {

/// Of the optimum `pose` (map <- vehicle), whose objective is given: over x y z roll pitch yaw [m, rad],
/// frame `map`.
[[nodiscard]] Matrix6 pose_covariance(const Objective& objective, const Pose& pose) noexcept;

/// The covariance of (v, w), the left perturbation of `pose` (see Objective), turned into one of x y z roll
/// pitch yaw.
[[nodiscard]] Matrix6 to_roll_pitch_yaw_covariance(const Matrix6& covariance, const Pose& pose) noexcept;

}  // namespace landfix::ndt
