// How uncertain a matched pose is.
//
// The score is no likelihood of independent measurements: a point counts with several voxels, and
// neighbouring points share them, their noise and their mistakes. So its inverse Hessian alone is no
// covariance. What is: the Hessian says how the pose gives way, and the groups of neighbouring points say how
// much they differ about it (the "sandwich" of Huber and White, robust to clusters: Liang and Zeger,
// "Longitudinal data analysis using generalized linear models", Biometrika 73, 1986).
#pragma once

#include "ndt/degeneracy.hpp"
#include "ndt/pose.hpp"
#include "ndt/scan_information.hpp"

namespace landfix::ndt {

/// Of the optimum `pose` (map <- vehicle), over x y z roll pitch yaw [m, rad], frame `map`. `guess_sigma_m`:
/// how far the guess, which the weak directions follow, may be off, as the displacement of points.
[[nodiscard]] Matrix6 pose_covariance(const ScanInformation& information, const Directions& directions,
                                      const Pose& pose, double guess_sigma_m) noexcept;

/// The covariance of (v, w), the left perturbation of `pose` (see Objective), turned into one of x y z roll
/// pitch yaw.
[[nodiscard]] Matrix6 to_roll_pitch_yaw_covariance(const Matrix6& covariance, const Pose& pose) noexcept;
/// The covariance of a Twist in the vehicle's axes turned into one of x y z roll pitch yaw, and back.
[[nodiscard]] Matrix6 from_vehicle_covariance(const Matrix6& covariance, const Pose& pose) noexcept;
[[nodiscard]] Matrix6 to_vehicle_covariance(const Matrix6& covariance, const Pose& pose) noexcept;

/// The step of Newton's method in the directions that are held.
[[nodiscard]] Twist held_step(const Objective& objective, const Directions& directions) noexcept;

}  // namespace landfix::ndt
