#include "ndt/motion.hpp"

#include <algorithm>

namespace landfix::ndt {

Velocity velocity_between(const StampedPose& from, const StampedPose& to) noexcept {
  const double duration_s = static_cast<double>(to.stamp_utc_ns - from.stamp_utc_ns) * 1e-9;
  if (!(duration_s > 0.0)) return Velocity::Zero();
  return pose_log(from.pose.inverse() * to.pose) / duration_s;
}

Pose predict(const StampedPose& from, const Velocity& velocity, std::int64_t stamp_utc_ns) noexcept {
  return from.pose * pose_exp(velocity * (static_cast<double>(stamp_utc_ns - from.stamp_utc_ns) * 1e-9));
}

Deskew::Deskew(const Velocity& velocity, float duration_s, const Pose& sensor_pose) noexcept {
  const double step_s = static_cast<double>(duration_s) / kSteps;
  if (step_s > 0.0) steps_per_s_ = static_cast<float>(1.0 / step_s);
  for (std::size_t i = 0; i <= kSteps; ++i) {
    const double before_end_s = step_s * static_cast<double>(i) - static_cast<double>(duration_s);
    steps_[i] = (pose_exp(velocity * before_end_s) * sensor_pose).affine().cast<float>();
  }
}

Eigen::Vector3f Deskew::operator()(const drivers::Point& point) const noexcept {
  const float place = std::clamp(point.time_s * steps_per_s_, 0.0F, static_cast<float>(kSteps));
  const std::size_t step = std::min(static_cast<std::size_t>(place), kSteps - 1);
  const Eigen::Vector4f p(point.x, point.y, point.z, 1.0F);
  const Eigen::Vector3f before = steps_[step] * p;
  const Eigen::Vector3f after = steps_[step + 1] * p;
  return before + (place - static_cast<float>(step)) * (after - before);
}

}  // namespace landfix::ndt
