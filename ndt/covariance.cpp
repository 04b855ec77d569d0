#include "ndt/covariance.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace landfix::ndt {
namespace {

// Fitted on simulated route A with a VLP-16, and checked on B and C with an HDL-32E and a Pandar64, filters
// of 0.7 to 5 m: the normalised error squared is 0.55 to 1.75 a degree of freedom.

/// By which a group's surfaces, taken together, lie beside where the map has them: the map's noise and the
/// discretisation of its voxels do not average out over neighbouring points.
constexpr double kGroupDisplacement_m = 0.004;
/// The scatter of n groups knows itself only to about 1/sqrt(n): so much of a group's Hessian, 1/n of the
/// scan's, is added as a prior.
constexpr double kPriorGroups = 3.0;
/// A vehicle on its springs heaves, rolls and pitches within a sweep as no constant velocity describes.
constexpr double kHeave_m = 1e-3;
constexpr double kSway_rad = 1e-4;

constexpr double kUnknown = 1e6;  // variance of what nothing tells [m^2, rad^2]

/// The inverse Hessian in the held directions, in the basis; 0 in the others. With as much of the curvature
/// as leaves it well above 0.
[[nodiscard]] Matrix6 held_inverse(const Objective& objective, const Directions& directions) noexcept {
  constexpr double kDefinite = 0.1;  // of the lattice's pull
  const Matrix6& basis = directions.basis;
  Matrix6 held = Matrix6::Zero();
  for (int i = 0; i < 6; ++i) held(i, i) = directions.is_weak[static_cast<std::size_t>(i)] ? 0.0 : 1.0;
  const auto in_basis = [&](const Matrix6& matrix) {
    return (held * basis.transpose() * matrix * basis * held).eval();
  };
  const Matrix6 rest = Matrix6::Identity() - held;
  const Matrix6 definite = in_basis(objective.definite) + rest;
  const Matrix6 curvature = in_basis(objective.curvature);
  Eigen::LDLT<Matrix6> ldlt;
  for (const double share : {1.0, 0.75, 0.5, 0.25, 0.0}) {
    ldlt.compute(definite - share * curvature);
    if (ldlt.info() == Eigen::Success && ldlt.vectorD().minCoeff() > kDefinite) break;
  }
  // By columns: Eigen's solver of several at once asks for cache sizes behind a lock.
  Matrix6 inverse;
  for (int i = 0; i < 6; ++i) inverse.col(i) = ldlt.solve(held.col(i).eval());
  return basis * inverse * basis.transpose();
}

/// Rates of roll, pitch and yaw of a rotation rate in map axes, R = Rz Ry Rx.
[[nodiscard]] Matrix6 to_angle_rates(const Pose& pose) noexcept {
  const RollPitchYaw angles = to_roll_pitch_yaw(pose.linear());
  const double cy = std::cos(angles.yaw_rad);
  const double sy = std::sin(angles.yaw_rad);
  const double cp = std::max(std::cos(angles.pitch_rad), 1e-6);
  const double tp = std::sin(angles.pitch_rad) / cp;
  Matrix6 jacobian = Matrix6::Identity();
  jacobian.bottomRightCorner<3, 3>() << cy / cp, sy / cp, 0.0,  //
      -sy, cy, 0.0,                                             //
      cy * tp, sy * tp, 1.0;
  return jacobian;
}

/// Its inverse: roll turns about the vehicle's x axis, yaw about the map's z.
[[nodiscard]] Matrix6 from_angle_rates(const Pose& pose) noexcept {
  const RollPitchYaw angles = to_roll_pitch_yaw(pose.linear());
  const double cy = std::cos(angles.yaw_rad);
  const double sy = std::sin(angles.yaw_rad);
  Matrix6 jacobian = Matrix6::Identity();
  jacobian.block<3, 1>(3, 3) = pose.linear().col(0);
  jacobian.block<3, 1>(3, 4) << -sy, cy, 0.0;
  return jacobian;
}

/// Of a Twist, from the vehicle's axes to the map's.
[[nodiscard]] Matrix6 to_map_axes(const Pose& pose) noexcept {
  Matrix6 rotation = Matrix6::Zero();
  rotation.topLeftCorner<3, 3>() = rotation.bottomRightCorner<3, 3>() = pose.linear();
  return rotation;
}

[[nodiscard]] Matrix6 transformed(const Matrix6& covariance, const Matrix6& jacobian) noexcept {
  return jacobian * covariance * jacobian.transpose();
}

}  // namespace

Matrix6 pose_covariance(const ScanInformation& information, const Directions& directions, const Pose& pose,
                        double guess_sigma_m) noexcept {
  if (information.groups == 0) return kUnknown * Matrix6::Identity();
  const Matrix6 inverse = held_inverse(information.objective, directions);
  const Matrix6 between_groups =
      information.scatter + kGroupDisplacement_m * kGroupDisplacement_m * information.displacement;
  Matrix6 covariance =
      inverse * between_groups * inverse + kPriorGroups / static_cast<double>(information.groups) * inverse;
  const double guess_sigma = directions.length_per_m * guess_sigma_m;
  for (int i = 0; i < 6; ++i) {
    if (!directions.is_weak[static_cast<std::size_t>(i)]) continue;
    covariance += guess_sigma * guess_sigma * directions.basis.col(i) * directions.basis.col(i).transpose();
  }
  const Twist springs =
      (Twist() << 0.0, 0.0, kHeave_m * kHeave_m, kSway_rad * kSway_rad, kSway_rad * kSway_rad, 0.0)
          .finished();
  return to_roll_pitch_yaw_covariance(covariance, pose) + from_vehicle_covariance(springs.asDiagonal(), pose);
}

Matrix6 to_roll_pitch_yaw_covariance(const Matrix6& covariance, const Pose& pose) noexcept {
  return transformed(covariance, to_angle_rates(pose));
}

Matrix6 from_vehicle_covariance(const Matrix6& covariance, const Pose& pose) noexcept {
  return transformed(covariance, to_angle_rates(pose) * to_map_axes(pose));
}

Matrix6 to_vehicle_covariance(const Matrix6& covariance, const Pose& pose) noexcept {
  return transformed(covariance, to_map_axes(pose).transpose() * from_angle_rates(pose));
}

Twist held_step(const Objective& objective, const Directions& directions) noexcept {
  return held_inverse(objective, directions) * objective.gradient;
}

}  // namespace landfix::ndt
