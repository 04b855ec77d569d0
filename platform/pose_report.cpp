#include "platform/pose_report.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace landfix::platform {
namespace {

/// To (-pi, pi].
double wrapped_rad(double angle_rad) noexcept {
  const double wrapped = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

void add_pose(PoseReport& report, const ndt::Pose& pose) noexcept {
  const ndt::RollPitchYaw angles = ndt::to_roll_pitch_yaw(pose.linear());
  report.x_m = pose.translation().x();
  report.y_m = pose.translation().y();
  report.z_m = pose.translation().z();
  report.roll_rad = wrapped_rad(angles.roll_rad);
  report.pitch_rad = angles.pitch_rad;
  report.yaw_rad = wrapped_rad(angles.yaw_rad);
}

void add_velocity(PoseReport& report, const ndt::Velocity& velocity) noexcept {
  report.speed_x_mps = velocity[0];
  report.speed_y_mps = velocity[1];
  report.speed_z_mps = velocity[2];
  report.roll_rate_radps = velocity[3];
  report.pitch_rate_radps = velocity[4];
  report.yaw_rate_radps = velocity[5];
}

/// `covariance`: in map axes; turned about the vertical to the heading.
void add_sigmas(PoseReport& report, const ndt::Matrix6& covariance, double yaw_rad) noexcept {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(-yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto sigmas = [&](const Eigen::Matrix3d& block) -> Eigen::Vector3d {
    return (turn * block * turn.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
  };
  const Eigen::Vector3d position_m = sigmas(covariance.topLeftCorner<3, 3>());
  const Eigen::Vector3d attitude_rad = sigmas(covariance.bottomRightCorner<3, 3>());
  report.sigma_along_m = position_m.x();
  report.sigma_cross_m = position_m.y();
  report.sigma_up_m = position_m.z();
  report.sigma_roll_rad = attitude_rad.x();
  report.sigma_pitch_rad = attitude_rad.y();
  report.sigma_yaw_rad = attitude_rad.z();
}

}  // namespace

PoseReport report_of(const ndt::Fix& fix, drivers::TimeSource time_source, bool is_whole_sweep) noexcept {
  PoseReport report;
  report.stamp_utc_ns = fix.at.stamp_utc_ns;
  report.age_s = 0.0;
  if (ndt::is_usable(fix.state)) {
    add_pose(report, fix.at.pose);
    add_velocity(report, fix.velocity);
    add_sigmas(report, fix.covariance, report.yaw_rad);
  }
  report.score = fix.match.nearest_voxel_likelihood / fix.match.best_likelihood;
  report.iterations = fix.match.iterations;
  report.state = static_cast<std::uint16_t>(fix.state);
  report.time_source = static_cast<std::uint16_t>(time_source);
  report.partial_sweep = is_whole_sweep ? 0 : 1;
  for (const ndt::WeakDirection& weak : fix.match.weak.all()) {
    report.weak_axes = static_cast<std::uint16_t>(report.weak_axes | 1U << static_cast<unsigned>(weak.axis));
  }
  report.weak = report.weak_axes != 0 ? 1 : 0;
  return report;
}

}  // namespace landfix::platform
