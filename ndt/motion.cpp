#include "ndt/motion.hpp"

namespace landfix::ndt {

Velocity velocity_between(const StampedPose& from, const StampedPose& to) noexcept {
  const double duration_s = static_cast<double>(to.stamp_utc_ns - from.stamp_utc_ns) * 1e-9;
  if (!(duration_s > 0.0)) return Velocity::Zero();
  return pose_log(from.pose.inverse() * to.pose) / duration_s;
}

Velocity steady_part(const Velocity& velocity) noexcept {
  Velocity steady = velocity;
  steady.segment<3>(2).setZero();  // z, roll, pitch
  return steady;
}

Pose predict(const StampedPose& from, const Velocity& velocity, std::int64_t stamp_utc_ns) noexcept {
  return from.pose * pose_exp(velocity * (static_cast<double>(stamp_utc_ns - from.stamp_utc_ns) * 1e-9));
}

void Deskew::begin(std::int64_t start_utc_ns, const Velocity& velocity, const Pose& sensor_pose) noexcept {
  start_utc_ns_ = start_utc_ns;
  velocity_ = velocity;
  const Pose step = pose_exp(velocity / static_cast<double>(kSteps_per_s));
  Pose vehicle = Pose::Identity();  // at the start <- at the step
  Eigen::Matrix4f pose = sensor_pose.matrix().cast<float>();
  for (Step& at : steps_) {
    vehicle = vehicle * step;
    const Eigen::Matrix4f next = (vehicle * sensor_pose).matrix().cast<float>();
    at = {.pose = pose, .change = next - pose};
    pose = next;
  }
}

Pose Deskew::from_start(std::int64_t stamp_utc_ns) const noexcept {
  return pose_exp(velocity_ * (static_cast<double>(start_utc_ns_ - stamp_utc_ns) * 1e-9));
}

}  // namespace landfix::ndt
