#include "ndt/mapper.hpp"

namespace landfix::ndt {
namespace {

/// Cells near the vehicle, of which a street within 250 m has some 200,000.
constexpr std::size_t kMostCellsNear = 8'000'000;
/// After which what has been left behind is forgotten.
constexpr double kForgetEach_m = 20.0;

}  // namespace

Mapper::Mapper(const MapperSettings& settings, const Pose& first_pose)
    : settings_(settings),
      matcher_(settings.matcher),
      builder_(settings.resolution_m, kMostCellsNear, settings.source),
      last_{.pose = first_pose},
      last_forgot_m_(first_pose.translation()) {}

Pose Mapper::predicted_pose(std::int64_t stamp_utc_ns) const noexcept {
  return is_first_ ? last_.pose : predict(last_, velocity_, stamp_utc_ns);
}

Velocity Mapper::velocity_to(const StampedPose& at) const noexcept {
  const bool is_later = !is_first_ && at.stamp_utc_ns > last_.stamp_utc_ns;
  return is_later ? velocity_between(last_, at) : velocity_;
}

MatchResult Mapper::match(std::span<const Eigen::Vector3f> points_m, std::int64_t stamp_utc_ns) {
  const Pose guess = predicted_pose(stamp_utc_ns);
  if (is_first_) return {.pose = guess, .points = points_m.size(), .converged = true};
  return matcher_.match(map_, points_m, guess);
}

bool Mapper::settle(const StampedPose& at) noexcept {
  velocity_ = velocity_to(at);
  if (!is_first_) travelled_m_ += (at.pose.translation() - last_.pose.translation()).norm();
  const bool is_wanted = is_first_ || travelled_m_ - last_added_m_ >= settings_.add_after_m;
  if (is_wanted) last_added_m_ = travelled_m_;
  last_ = at;
  is_first_ = false;
  return is_wanted;
}

void Mapper::add(std::span<const Eigen::Vector3f> points_m, const Pose& pose) {
  for (const Eigen::Vector3f& point_m : points_m) builder_.add(pose * point_m.cast<double>());
  if ((pose.translation() - last_forgot_m_).norm() > kForgetEach_m) {
    builder_.forget_beyond(pose.translation(), settings_.forget_beyond_m);
    last_forgot_m_ = pose.translation();
  }
  image_ = builder_.build();
  map_ = VoxelMap(image_.bytes());
}

}  // namespace landfix::ndt
