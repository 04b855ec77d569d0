#include "ndt/pose.hpp"

#include <algorithm>
#include <cmath>

namespace landfix::ndt {
namespace {

// Below this angle the closed forms lose digits and their Taylor series are exact to double precision.
constexpr double kSmallAngle_rad = 1e-4;

/// V of the SE(3) exponential: translation = V * (translational part of the twist).
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& rotation_rad) noexcept {
  const double angle = rotation_rad.norm();
  const Eigen::Matrix3d k = skew(rotation_rad);
  if (angle < kSmallAngle_rad) {
    return Eigen::Matrix3d::Identity() + 0.5 * k + (1.0 / 6.0) * k * k;
  }
  const double a = (1.0 - std::cos(angle)) / (angle * angle);
  const double b = (angle - std::sin(angle)) / (angle * angle * angle);
  return Eigen::Matrix3d::Identity() + a * k + b * k * k;
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) noexcept {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(),  //
      v.z(), 0.0, -v.x(),   //
      -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Matrix3d rotation_exp(const Eigen::Vector3d& rotation_rad) noexcept {
  const double angle = rotation_rad.norm();
  const Eigen::Matrix3d k = skew(rotation_rad);
  if (angle < kSmallAngle_rad) {
    return Eigen::Matrix3d::Identity() + (1.0 - angle * angle / 6.0) * k +
           (0.5 - angle * angle / 24.0) * k * k;
  }
  return Eigen::Matrix3d::Identity() + std::sin(angle) / angle * k +
         (1.0 - std::cos(angle)) / (angle * angle) * k * k;
}

Eigen::Vector3d rotation_log(const Eigen::Matrix3d& rotation) noexcept {
  // Through the quaternion: well conditioned at small angles and near pi alike.
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  const double angle = 2.0 * std::atan2(sine, q.w());
  return sine < 1e-12 ? Eigen::Vector3d(2.0 * q.vec()) : Eigen::Vector3d(angle / sine * q.vec());
}

Pose pose_exp(const Twist& twist) noexcept {
  Pose pose = Pose::Identity();
  pose.linear() = rotation_exp(twist.tail<3>());
  pose.translation() = left_jacobian(twist.tail<3>()) * twist.head<3>();
  return pose;
}

Twist pose_log(const Pose& pose) noexcept {
  Twist twist;
  twist.tail<3>() = rotation_log(pose.linear());
  twist.head<3>() = left_jacobian(twist.tail<3>()).inverse() * pose.translation();
  return twist;
}

Eigen::Matrix3d to_rotation(const RollPitchYaw& angles) noexcept {
  return (Eigen::AngleAxisd(angles.yaw_rad, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(angles.pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles.roll_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

RollPitchYaw to_roll_pitch_yaw(const Eigen::Matrix3d& r) noexcept {
  const double pitch = std::asin(std::clamp(-r(2, 0), -1.0, 1.0));
  if (std::hypot(r(0, 0), r(1, 0)) < 1e-9) {
    // Nose straight up or down: only yaw -+ roll is defined.
    return {.roll_rad = std::atan2(-r(1, 2), r(1, 1)), .pitch_rad = pitch, .yaw_rad = 0.0};
  }
  return {
      .roll_rad = std::atan2(r(2, 1), r(2, 2)), .pitch_rad = pitch, .yaw_rad = std::atan2(r(1, 0), r(0, 0))};
}

Pose make_pose(const Eigen::Vector3d& translation_m, const RollPitchYaw& angles) noexcept {
  Pose pose = Pose::Identity();
  pose.linear() = to_rotation(angles);
  pose.translation() = translation_m;
  return pose;
}

Pose moved(const Pose& pose, const Twist& step) noexcept {
  Pose result = pose;
  result.linear() = rotation_exp(step.tail<3>()) * pose.linear();
  result.translation() += step.head<3>();
  return result;
}

Twist step_between(const Pose& from, const Pose& to) noexcept {
  Twist step;
  step << to.translation() - from.translation(), rotation_log(to.linear() * from.linear().transpose());
  return step;
}

double angle_between(const Pose& a, const Pose& b) noexcept {
  return rotation_log(a.linear().transpose() * b.linear()).norm();
}

}  // namespace landfix::ndt
