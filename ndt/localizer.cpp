#include "ndt/localizer.hpp"

#include <algorithm>
#include <utility>

#include "ndt/covariance.hpp"

namespace landfix::ndt {
namespace {

/// By which a sweep's own velocity may be wrong: at 10 Hz, half a turn long, it displaces it by 0.1 m.
constexpr double kDistorts_mps = 2.0;

[[nodiscard]] std::optional<double> sigma_of(const std::optional<MeasuredMotion>& measured) noexcept {
  return measured ? measured->sigma_mps : std::nullopt;
}

}  // namespace

std::string_view to_string(State state) noexcept {
  const auto number = static_cast<std::size_t>(state);
  return number < kStateNames.size() ? kStateNames[number] : "UNKNOWN";
}

Fix Localizer::localize(std::span<const Eigen::Vector3f> points_m, std::int64_t stamp_utc_ns,
                        const std::optional<MeasuredMotion>& measured, const Deadline& deadline,
                        const std::optional<Velocity>& undistorted_with) noexcept {
  begin_time(stamp_utc_ns);
  reckoning_.pass(seconds_between(last_.stamp_utc_ns, stamp_utc_ns), sigma_of(measured));
  Fix fix{.at = {stamp_utc_ns, predicted_pose(stamp_utc_ns, measured)}};
  const Velocity before = velocity();
  const bool elsewhere = is_elsewhere(fix.at);
  if (elsewhere && is_usable(state_)) state_ = State::lost;
  if (state_ == State::lost || !has_pose_ || elsewhere) {
    recover(fix, look_around(points_m, fix.at, undistorted_with.value_or(velocity()), deadline));
  } else {
    fix.match = matcher_.match(map_, points_m, fix.at.pose, reckoning_.sigma_m(), deadline);
    fix.state = next_state(fix);
    if (fix.state == State::init && guess_) has_pose_ = false;  // it is not there
  }
  found_.reset();
  if (fix.state >= State::degraded) {
    const bool is_first = state_ == State::init;
    take_match(fix);
    // What it was undistorted with is a guess before there are two, and may then be found wrong.
    const double wrong_mps = (velocity_ - undistorted_with.value_or(before)).head<3>().norm();
    const bool is_distorted = !measured && (is_first || wrong_mps > kDistorts_mps);
    if (is_distorted && fix.state == State::tracking) fix.state = State::degraded;
  } else if (fix.state == State::predicted) {
    fix.covariance = predicted_covariance(reckoning_, fix.at.pose);
  } else if (fix.state == State::lost && !measured) {
    // Wait where the last usable pose was: after a leap of the clock the prediction may be anywhere.
    fix.at.pose = last_.pose;
    stand_still(last_.pose);
  }
  fix.velocity = measured ? measured->velocity : velocity_;
  count_doubt(fix);
  last_ = fix.at;
  last_sweep_utc_ns_ = stamp_utc_ns;
  state_ = fix.state;
  return fix;
}

Fix Localizer::predict_missing(std::int64_t stamp_utc_ns,
                               const std::optional<MeasuredMotion>& measured) const noexcept {
  Fix fix{.at = {stamp_utc_ns, last_.pose}, .state = state_without_match(stamp_utc_ns)};
  if (fix.state != State::predicted) return fix;
  DeadReckoning reckoning = reckoning_;
  reckoning.pass(seconds_between(last_.stamp_utc_ns, stamp_utc_ns), sigma_of(measured));
  fix.at.pose = predicted_pose(stamp_utc_ns, measured);
  fix.velocity = measured ? measured->velocity : velocity_;
  fix.covariance = predicted_covariance(reckoning, fix.at.pose);
  return fix;
}

Fix Localizer::wait_for_data(std::int64_t stamp_utc_ns,
                             const std::optional<MeasuredMotion>& measured) noexcept {
  if (measured) {
    reckoning_.pass(seconds_between(last_.stamp_utc_ns, stamp_utc_ns), sigma_of(measured));
    last_ = {stamp_utc_ns, predicted_pose(stamp_utc_ns, measured)};
    velocity_ = measured->velocity;
  } else {
    const auto lost_after_ns = static_cast<std::int64_t>(settings_.lost_after_s * 1e9);
    stand_still(predict(last_, velocity_, last_.stamp_utc_ns + lost_after_ns));
  }
  if (state_ != State::init) state_ = State::lost;
  return {.at = {stamp_utc_ns, last_.pose}, .state = State::no_data};
}

Pose Localizer::predicted_pose(std::int64_t stamp_utc_ns,
                               const std::optional<MeasuredMotion>& measured) const noexcept {
  return measured ? last_.pose * measured->change : predict(last_, velocity_, stamp_utc_ns);
}

/// Where a clock was set while the sweeps kept coming, it is as if one period had passed.
void Localizer::begin_time(std::int64_t stamp_utc_ns) noexcept {
  constexpr std::int64_t kSetBack_ns = 500'000'000;
  constexpr std::int64_t kSetForward_ns = 2'000'000'000;  // a silence is told sooner, and is no leap
  if (!std::exchange(any_sweep_, true)) {
    last_.stamp_utc_ns = stamp_utc_ns;
    last_matched_ = last_;
    last_sweep_utc_ns_ = stamp_utc_ns;
  }
  const std::int64_t since_sweep_ns = stamp_utc_ns - last_sweep_utc_ns_;
  const bool is_forward = since_sweep_ns > kSetForward_ns && state_ >= State::predicted;
  if (since_sweep_ns < -kSetBack_ns || is_forward) {
    clock_was_set_ = true;
    const std::int64_t leap_ns = since_sweep_ns - period_ns_;
    last_.stamp_utc_ns += leap_ns;
    last_matched_.stamp_utc_ns += leap_ns;
    last_sweep_utc_ns_ += leap_ns;
  }
  last_sweep_utc_ns_ = std::min(last_sweep_utc_ns_, stamp_utc_ns);
  last_.stamp_utc_ns = std::min(last_.stamp_utc_ns, stamp_utc_ns);
  last_matched_.stamp_utc_ns = std::min(last_matched_.stamp_utc_ns, stamp_utc_ns);
  learn_period(stamp_utc_ns - last_sweep_utc_ns_);
}

void Localizer::learn_period(std::int64_t between_ns) noexcept {
  constexpr std::int64_t kShortest_ns = 40'000'000;
  constexpr std::int64_t kLongest_ns = 250'000'000;
  if (between_ns >= kShortest_ns && between_ns <= kLongest_ns) period_ns_ = between_ns;
}

State Localizer::next_state(const Fix& fix) const noexcept {
  const Pose& prediction = fix.at.pose;
  const double since_sweep_s = static_cast<double>(fix.at.stamp_utc_ns - last_sweep_utc_ns_) * 1e-9;
  const double share =
      std::clamp(since_sweep_s / settings_.innovation_full_after_s, settings_.innovation_least_share, 1.0);
  const bool is_near = (fix.match.pose.translation() - prediction.translation()).norm() <
                           share * settings_.innovation_limit_m &&
                       angle_between(fix.match.pose, prediction) < share * settings_.innovation_limit_rad;
  // A match that follows the prediction in weak directions is worth no more than that.
  const bool is_anchored =
      fix.match.weak.count == 0 ||
      seconds_between(last_matched_.stamp_utc_ns, fix.at.stamp_utc_ns) <= settings_.lost_after_s;
  const Fit fit = judge(fix.match, settings_.gates);
  const bool is_believed = state_ == State::init ? agrees_with_guess(fix.match.pose) : is_near && is_anchored;
  if (fit != Fit::none && is_believed) {
    return fit == Fit::good && fix.match.weak.count == 0 ? State::tracking : State::degraded;
  }
  return state_without_match(fix.at.stamp_utc_ns);
}

bool Localizer::agrees_with_guess(const Pose& pose) const noexcept {
  constexpr double kMargin_m = 2.0;
  return !guess_ ||
         (pose.translation().head<2>() - guess_->position_m).norm() <= guess_->within_m + kMargin_m;
}

State Localizer::state_without_match(std::int64_t stamp_utc_ns) const noexcept {
  if (state_ == State::init || state_ == State::lost) return state_;
  const double unmatched_s = seconds_between(last_matched_.stamp_utc_ns, stamp_utc_ns);
  return unmatched_s > settings_.lost_after_s ? State::lost : State::predicted;
}

Matrix6 Localizer::predicted_covariance(const DeadReckoning& reckoning, const Pose& pose) const noexcept {
  return last_covariance_ + from_vehicle_covariance(reckoning.covariance(), pose);
}

/// The prediction gives way to the match, which shows what the prediction was worth and the velocity.
void Localizer::take_match(Fix& fix) noexcept {
  const Pose prediction = std::exchange(fix.at.pose, fix.match.pose);
  fix.covariance = fix.match.covariance + from_vehicle_covariance(distortion_.covariance(), fix.at.pose);
  last_covariance_ = fix.covariance;
  // How long it was since a match before the clock was set is not known.
  const bool clock_was_set = std::exchange(clock_was_set_, false);
  const bool is_baseline =
      !clock_was_set &&
      seconds_between(last_matched_.stamp_utc_ns, fix.at.stamp_utc_ns) >= settings_.shortest_baseline_s;
  if (fix.match.weak.count == 0) {
    reckoning_.hold(state_ != State::init && is_baseline);
    if (state_ >= State::degraded) distortion_.observe(pose_log(prediction.inverse() * fix.at.pose));
  }
  if (state_ != State::init && is_baseline) velocity_ = steady_part(velocity_between(last_matched_, fix.at));
  if (state_ == State::init || is_baseline || clock_was_set) last_matched_ = fix.at;
  recovery_.remember(fix.at, velocity_, fix.match);
}

/// Who has searched the whole map knows of all that looks like the place. An answer that is not of the sweep
/// before, as after a leap of the clock, is none.
bool Localizer::is_elsewhere(const StampedPose& prediction) const noexcept {
  constexpr double kElsewhere_m = 1.0;
  constexpr double kElsewhere_rad = 0.1;
  constexpr double kOldest_s = 0.5;
  if (!found_) return false;
  const double age_s = seconds_between(found_->at.stamp_utc_ns, prediction.stamp_utc_ns);
  if (age_s <= 0.0 || age_s > kOldest_s) return false;
  const Pose there = predict(found_->at, found_->velocity, prediction.stamp_utc_ns);
  return (there.translation() - prediction.pose.translation()).norm() > kElsewhere_m ||
         angle_between(there, prediction.pose) > kElsewhere_rad;
}

Sighting Localizer::look_around(std::span<const Eigen::Vector3f> points_m, const StampedPose& prediction,
                                const Velocity& undistorted_with, const Deadline& deadline) noexcept {
  if (found_) {
    Sighting there = recovery_.check(matcher_, map_, points_m, prediction.stamp_utc_ns, *found_,
                                     undistorted_with, deadline);
    if (there.confirmed) return there;
  }
  return recovery_.look(matcher_, map_, points_m, prediction, undistorted_with, guess_, deadline);
}

/// A good match that was not believed says nothing.
void Localizer::count_doubt(const Fix& fix) noexcept {
  const bool is_good = fix.state >= State::degraded && judge(fix.match, settings_.gates) == Fit::good;
  unsure_s_ = is_good ? 0.0 : unsure_s_ + seconds_between(last_sweep_utc_ns_, fix.at.stamp_utc_ns);
}

/// What was confirmed goes on from the sweep before, not from where the vehicle was lost.
void Localizer::recover(Fix& fix, const Sighting& sighting) noexcept {
  fix.match = sighting.match;
  fix.state = sighting.confirmed ? State::tracking : state_;
  if (sighting.confirmed) {
    last_matched_ = sighting.before;
    clock_was_set_ = false;
    has_pose_ = true;
    state_ = State::lost;  // in which it is found: its motion is known
  } else if (state_ == State::init && guess_) {
    fix.at.pose.translation().head<2>() = guess_->position_m;  // around which the map is needed
  }
}

void Localizer::stand_still(const Pose& pose) noexcept {
  last_.pose = pose;
  velocity_.setZero();
  reckoning_ = DeadReckoning();
}

}  // namespace landfix::ndt
