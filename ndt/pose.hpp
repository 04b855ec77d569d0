// Poses: rigid transforms in three dimensions, their exponential map, and roll, pitch, yaw.
#pragma once

#include <cstdint>
#include <numbers>

#include <Eigen/Geometry>

namespace landfix::ndt {

/// `map <- vehicle` unless its name says otherwise.
using Pose = Eigen::Isometry3d;
/// Translation [m], then rotation vector [rad].
using Twist = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Files and the command line speak of degrees, the code of radians.
inline constexpr double kRadians_per_deg = std::numbers::pi / 180.0;

/// A pose at a time.
struct StampedPose {
  std::int64_t stamp_utc_ns = 0;  ///< Unix nanoseconds UTC
  Pose pose = Pose::Identity();
};

[[nodiscard]] constexpr double seconds_between(std::int64_t from_ns, std::int64_t to_ns) noexcept {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

/// R = Rz(yaw) Ry(pitch) Rx(roll); positive pitch is nose down (ISO 8855).
struct RollPitchYaw {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
};

[[nodiscard]] Eigen::Matrix3d skew(const Eigen::Vector3d& v) noexcept;

/// Rotation by |rotation_rad| about rotation_rad.
[[nodiscard]] Eigen::Matrix3d rotation_exp(const Eigen::Vector3d& rotation_rad) noexcept;
/// Rotation vector of a rotation matrix, its norm in [0, pi].
[[nodiscard]] Eigen::Vector3d rotation_log(const Eigen::Matrix3d& rotation) noexcept;

/// Motion at a constant twist of the moving frame for one unit of time (SE(3) exponential), and its inverse.
[[nodiscard]] Pose pose_exp(const Twist& twist) noexcept;
[[nodiscard]] Twist pose_log(const Pose& pose) noexcept;

[[nodiscard]] Eigen::Matrix3d to_rotation(const RollPitchYaw& angles) noexcept;
/// Pitch in [-pi/2, pi/2]; at its ends yaw is 0 and roll takes the rest.
[[nodiscard]] RollPitchYaw to_roll_pitch_yaw(const Eigen::Matrix3d& rotation) noexcept;
[[nodiscard]] Pose make_pose(const Eigen::Vector3d& translation_m, const RollPitchYaw& angles) noexcept;

/// The left perturbation about the vehicle: R <- exp(w) R, t <- t + v, for a twist (v, w) in map axes; and
/// the one that leads from a pose to another.
[[nodiscard]] Pose moved(const Pose& pose, const Twist& step) noexcept;
[[nodiscard]] Twist step_between(const Pose& from, const Pose& to) noexcept;

/// Angle of the rotation between two poses [rad].
[[nodiscard]] double angle_between(const Pose& a, const Pose& b) noexcept;

}  // namespace landfix::ndt
