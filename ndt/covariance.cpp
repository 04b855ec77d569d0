#include "ndt/covariance.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace landfix::ndt {
namespace {

/// Laplace's approximation: the inverse Hessian at the maximum.
[[nodiscard]] Matrix6 laplace_covariance(const Objective& objective) noexcept {
  constexpr double kUnknown = 1e-6;  // information that stands for none: 1000 m, 1000 rad
  const Eigen::LDLT<Matrix6> ldlt(objective.definite + kUnknown * Matrix6::Identity());
  // By columns: Eigen's solver of several at once asks for cache sizes behind a lock.
  Matrix6 inverse;
  for (int i = 0; i < 6; ++i) inverse.col(i) = ldlt.solve(Twist::Unit(i).eval());
  return inverse;
}

}  // namespace

Matrix6 pose_covariance(const Objective& objective, const Pose& pose) noexcept {
  return to_roll_pitch_yaw_covariance(laplace_covariance(objective), pose);
}

Matrix6 to_roll_pitch_yaw_covariance(const Matrix6& covariance, const Pose& pose) noexcept {
  const RollPitchYaw angles = to_roll_pitch_yaw(pose.linear());
  const double cy = std::cos(angles.yaw_rad);
  const double sy = std::sin(angles.yaw_rad);
  const double cp = std::max(std::cos(angles.pitch_rad), 1e-6);
  const double tp = std::sin(angles.pitch_rad) / cp;
  // Rates of roll, pitch and yaw of a rotation rate in map axes, R = Rz Ry Rx.
  Matrix6 jacobian = Matrix6::Identity();
  jacobian.bottomRightCorner<3, 3>() << cy / cp, sy / cp, 0.0,  //
      -sy, cy, 0.0,                                             //
      cy * tp, sy * tp, 1.0;
  return jacobian * covariance * jacobian.transpose();
}

}  // namespace landfix::ndt
