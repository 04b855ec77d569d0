#include "ndt/track.hpp"

#include <cmath>

namespace landfix::ndt {
namespace {

/// A second sweep is looked for within this, as the velocity of the first is a guess; a third by its motion.
constexpr double kFirstStep_m = 3.0;
constexpr double kStep_m = 0.6;
constexpr double kStep_rad = 0.08;
/// Between sweeps that are held against each other.
constexpr double kShortestStep_s = 0.04;
constexpr double kLongestStep_s = 0.5;
/// Of sweeps that agree.
constexpr double kAgreement_m = 0.25;
constexpr double kAgreement_rad = 0.03;
/// Of a road vehicle, which hardly reverses and hardly slips.
constexpr double kFastestReverse_mps = 3.0;
constexpr double kFastestSlip_mps = 1.5;

[[nodiscard]] bool is_drivable(const Velocity& velocity) noexcept {
  return velocity[0] > -kFastestReverse_mps && std::abs(velocity[1]) < kFastestSlip_mps;
}

}  // namespace

bool Track::is_splinter(std::int64_t stamp_utc_ns) const noexcept {
  const double step_s = seconds_between(at_.stamp_utc_ns, stamp_utc_ns);
  return step_s > 0.0 && step_s < kShortestStep_s;
}

void Track::begin(const StampedPose& at, double explained, const Velocity& velocity,
                  const Velocity& undistorted_with) noexcept {
  at_ = at;
  explained_ = explained;
  sweeps_ = 1;
  agreeing_ = 0;
  velocity_ = velocity;
  first_undistorted_with_ = undistorted_with;
}

void Track::follow(const MatchResult& match, const StampedPose& expected, const Velocity& undistorted_with,
                   double least_explained) noexcept {
  const bool is_first_step = sweeps_ == 1;
  const double step_s = seconds_between(at_.stamp_utc_ns, expected.stamp_utc_ns);
  StampedPose at{expected.stamp_utc_ns, match.pose};
  const Velocity velocity = is_first_step ? Velocity(steady_part(velocity_between(at_, at)) -
                                                     0.5 * (undistorted_with - first_undistorted_with_))
                                          : velocity_;
  // A sweep that was undistorted with a velocity that is wrong seems to be where it was half a turn before
  // its end, by what the velocity is wrong.
  at.pose = at.pose * pose_exp(0.5 * step_s * (velocity - undistorted_with));
  const double off_m = (at.pose.translation() - expected.pose.translation()).norm();
  const double off_rad = angle_between(at.pose, expected.pose);
  const bool goes_on = step_s > 0.0 && step_s < kLongestStep_s && judge(match, gates_) == Fit::good &&
                       off_m <= (is_first_step ? kFirstStep_m : kStep_m) && off_rad <= kStep_rad;
  if (!goes_on) {
    drop();
    return;
  }
  velocity_ = is_first_step ? velocity : steady_part(velocity_between(at_, at));
  const bool agrees = !is_first_step && off_m < kAgreement_m && off_rad < kAgreement_rad &&
                      match.weak.count == 0 && is_drivable(velocity_) && match.explained() >= least_explained;
  at_ = at;
  explained_ = match.explained();
  ++sweeps_;
  agreeing_ = agrees ? agreeing_ + 1 : 0;
}

}  // namespace landfix::ndt
