#include "tools/covariance_check.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include "platform/trajectory.hpp"

namespace landfix::tools {
namespace {

/// x y z roll pitch yaw; angles that were turned full circle are not far apart.
[[nodiscard]] ndt::Twist error_of(const ndt::Pose& pose, const ndt::Pose& truth) {
  const ndt::RollPitchYaw is = ndt::to_roll_pitch_yaw(pose.linear());
  const ndt::RollPitchYaw should = ndt::to_roll_pitch_yaw(truth.linear());
  const auto difference = [](double a, double b) { return std::remainder(a - b, 2.0 * std::numbers::pi); };
  ndt::Twist error;
  error << pose.translation() - truth.translation(), difference(is.roll_rad, should.roll_rad),
      difference(is.pitch_rad, should.pitch_rad), difference(is.yaw_rad, should.yaw_rad);
  return error;
}

}  // namespace

CovarianceCheck check_covariances(std::span<const platform::SweepResult> sweeps,
                                  std::span<const ndt::StampedPose> truth) {
  CovarianceCheck check;
  for (const platform::SweepResult& sweep : sweeps) {
    const ndt::Fix& fix = sweep.fix;
    const auto true_pose = platform::interpolate(truth, fix.at.stamp_utc_ns);
    if (fix.state < ndt::State::degraded || !true_pose) continue;
    const ndt::Twist error = error_of(fix.at.pose, *true_pose);
    ++check.sweeps;
    check.per_degree_of_freedom += error.dot(fix.covariance.ldlt().solve(error)) / 6.0;
    for (std::size_t i = 0; i < 6; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      check.by_axis[i] += error[k] * error[k] / fix.covariance(k, k);
    }
  }
  const auto count = static_cast<double>(check.sweeps);  // 0 / 0 is NaN
  check.per_degree_of_freedom /= count;
  for (double& mean : check.by_axis) mean /= count;
  return check;
}

}  // namespace landfix::tools
