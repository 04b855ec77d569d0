#include "ndt/localizer.hpp"

#include <algorithm>
#include <utility>

#include "ndt/covariance.hpp"

namespace landfix::ndt {
namespace {

[[nodiscard]] double seconds_between(const StampedPose& before, std::int64_t stamp_utc_ns) noexcept {
  return static_cast<double>(stamp_utc_ns - before.stamp_utc_ns) * 1e-9;
}

[[nodiscard]] std::optional<double> sigma_of(const std::optional<MeasuredMotion>& measured) noexcept {
  return measured ? measured->sigma_mps : std::nullopt;
}

}  // namespace

std::string_view to_string(State state) noexcept {
  const auto number = static_cast<std::size_t>(state);
  return number < kStateNames.size() ? kStateNames[number] : "UNKNOWN";
}

std::string_view to_string(Fit fit) noexcept {
  switch (fit) {
    case Fit::none:
      return "none";
    case Fit::weak:
      return "weak";
    case Fit::good:
      return "good";
  }
  return "unknown";
}

Fit judge(const MatchResult& match, const FitGates& gates) noexcept {
  const double likelihood = match.nearest_voxel_likelihood / match.best_likelihood;
  if (!match.converged || !(likelihood >= gates.believed_likelihood)) return Fit::none;
  const double matched_share = static_cast<double>(match.points_matched) / static_cast<double>(match.points);
  return likelihood >= gates.good_likelihood && matched_share >= gates.good_matched_share ? Fit::good
                                                                                          : Fit::weak;
}

Fix Localizer::localize(std::span<const Eigen::Vector3f> points_m, std::int64_t stamp_utc_ns,
                        const std::optional<MeasuredMotion>& measured, const Deadline& deadline) noexcept {
  begin_time(stamp_utc_ns);
  reckoning_.pass(seconds_between(last_, stamp_utc_ns), sigma_of(measured));
  Fix fix{.at = {stamp_utc_ns, predicted_pose(stamp_utc_ns, measured)}};
  if (state_ == State::lost || !has_pose_) {
    recover(fix, recovery_.look(matcher_, map_, points_m, fix.at, guess_, deadline));
  } else {
    fix.match = matcher_.match(map_, points_m, fix.at.pose, reckoning_.sigma_m(), deadline);
    fix.state = next_state(fix);
    if (fix.state == State::init && guess_) has_pose_ = false;  // it is not there
  }
  if (fix.state >= State::degraded) {
    take_match(fix);
  } else if (fix.state == State::predicted) {
    fix.covariance = predicted_covariance(reckoning_, fix.at.pose);
  } else if (fix.state == State::lost && !measured) {
    // Wait where the last usable pose was: after a leap of the clock the prediction may be anywhere.
    fix.at.pose = last_.pose;
    stand_still(last_.pose);
  }
  fix.velocity = measured ? measured->velocity : velocity_;
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
  reckoning.pass(seconds_between(last_, stamp_utc_ns), sigma_of(measured));
  fix.at.pose = predicted_pose(stamp_utc_ns, measured);
  fix.velocity = measured ? measured->velocity : velocity_;
  fix.covariance = predicted_covariance(reckoning, fix.at.pose);
  return fix;
}

Fix Localizer::wait_for_data(std::int64_t stamp_utc_ns,
                             const std::optional<MeasuredMotion>& measured) noexcept {
  if (measured) {
    reckoning_.pass(seconds_between(last_, stamp_utc_ns), sigma_of(measured));
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
  const bool is_anchored = fix.match.weak.count == 0 ||
                           seconds_between(last_matched_, fix.at.stamp_utc_ns) <= settings_.lost_after_s;
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
  const double unmatched_s = seconds_between(last_matched_, stamp_utc_ns);
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
      !clock_was_set && seconds_between(last_matched_, fix.at.stamp_utc_ns) >= settings_.shortest_baseline_s;
  if (fix.match.weak.count == 0) {
    reckoning_.hold(state_ != State::init && is_baseline);
    if (state_ >= State::degraded) distortion_.observe(pose_log(prediction.inverse() * fix.at.pose));
  }
  if (state_ != State::init && is_baseline) velocity_ = steady_part(velocity_between(last_matched_, fix.at));
  if (state_ == State::init || is_baseline || clock_was_set) last_matched_ = fix.at;
  recovery_.remember(fix.at, velocity_, fix.match);
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
