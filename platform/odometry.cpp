#include "platform/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "ndt/pose.hpp"

namespace landfix::platform {
namespace {

/// The standard deviation that a believed speed is given beside its mean disagreement with the LiDAR: tyres
/// differ by 1 % with wear and pressure, 0.05 m/s at 5 m/s (steps of real signals are 0.002 to 0.01 m/s).
constexpr double kSigma_mps = 0.05;
constexpr std::int64_t kStep_ns = 10'000'000;
constexpr std::int64_t kLongest_ns = 4'000'000'000;

// Full braking on a dry road is 12 m/s^2, turning in at the limit 3 rad/s^2. One sweep's match tells the
// speed to 0.2 m/s and the yaw rate to 0.012 rad/s, the mean over some of them to a third of that.
constexpr ChannelLimits kSpeedLimits{
    .rate = 15.0, .slack = 0.5, .tolerance = 0.3, .tolerance_share = 0.05, .timeout_ns = 200'000'000};
constexpr ChannelLimits kYawRateLimits{
    .rate = 5.0, .slack = 0.05, .tolerance = 0.03, .tolerance_share = 0.1, .timeout_ns = 200'000'000};

[[nodiscard]] bool is_wheel(VehicleRole role) noexcept {
  return role >= VehicleRole::wheel_fl && role <= VehicleRole::wheel_rr;
}

/// With the longest time-out of the signals that `counts`.
template <class Counts>
[[nodiscard]] ChannelLimits limits_for(const OdometrySettings& settings, ChannelLimits limits,
                                       Counts counts) {
  std::int64_t longest_ns = 0;
  for (const VehicleSignal& signal : settings.all()) {
    if (counts(signal.role)) longest_ns = std::max(longest_ns, signal.timeout_ns);
  }
  if (longest_ns != 0) limits.timeout_ns = longest_ns;
  return limits;
}

}  // namespace

Odometry::Odometry(const OdometrySettings& settings) noexcept
    : settings_(settings),
      speed_(limits_for(settings, kSpeedLimits,
                        [](VehicleRole role) { return role == VehicleRole::speed || is_wheel(role); })),
      yaw_rate_(limits_for(settings, kYawRateLimits,
                           [](VehicleRole role) { return role == VehicleRole::yaw_rate || is_wheel(role); })),
      has_speed_(settings.has(VehicleRole::speed)),
      has_yaw_rate_(settings.has(VehicleRole::yaw_rate)),
      has_reverse_(settings.has(VehicleRole::reverse)) {}

void Odometry::add(const CanFrame& frame, std::int64_t stamp_utc_ns) noexcept {
  bool any = false;
  bool any_wheel = false;
  bool any_speed = false;
  for (const VehicleSignal& signal : settings_.all()) {
    if (!signal.is_in(frame)) continue;
    any = true;
    const auto value = value_of(signal, frame);
    if (!value) {
      ++counters_.invalid;
      continue;
    }
    latest_[static_cast<std::size_t>(signal.role)].set(*value, stamp_utc_ns, signal.timeout_ns);
    any_wheel |= is_wheel(signal.role);
    any_speed |= signal.role == VehicleRole::speed;
    if (signal.role == VehicleRole::yaw_rate) count(yaw_rate_.add(stamp_utc_ns, *value));
  }
  counters_.frames += any ? 1 : 0;
  // After all of the frame is known: the reverse gear may stand beside the speed.
  if (any_speed) add_speed(*latest(VehicleRole::speed, stamp_utc_ns), stamp_utc_ns);
  if (any_wheel) add_wheels(stamp_utc_ns);
}

std::optional<double> Odometry::latest(VehicleRole role, std::int64_t stamp_utc_ns) const noexcept {
  return latest_[static_cast<std::size_t>(role)].at(stamp_utc_ns);
}

std::optional<double> Odometry::direction(std::int64_t stamp_utc_ns) const noexcept {
  if (!has_reverse_) return 1.0;
  const auto reverse = latest(VehicleRole::reverse, stamp_utc_ns);
  if (!reverse) return std::nullopt;
  return *reverse != 0.0 ? -1.0 : 1.0;
}

void Odometry::add_speed(double speed_mps, std::int64_t stamp_utc_ns) noexcept {
  const auto sign = direction(stamp_utc_ns);
  if (sign) {
    count(speed_.add(stamp_utc_ns, *sign * speed_mps));
  } else {
    ++counters_.invalid;
  }
}

void Odometry::add_wheels(std::int64_t stamp_utc_ns) noexcept {
  const auto pair = [&](VehicleRole left, VehicleRole right) -> std::optional<std::array<double, 2>> {
    const auto left_mps = latest(left, stamp_utc_ns);
    const auto right_mps = latest(right, stamp_utc_ns);
    if (!left_mps || !right_mps) return std::nullopt;
    return std::array{*left_mps, *right_mps};
  };
  const auto rear_mps = pair(VehicleRole::wheel_rl, VehicleRole::wheel_rr);
  const auto front_mps = pair(VehicleRole::wheel_fl, VehicleRole::wheel_fr);
  // The pose is that of the rear axle; the front wheels go a little farther in a curve.
  const auto& wheels_mps = rear_mps ? rear_mps : front_mps;
  if (wheels_mps && !has_speed_) add_speed(0.5 * ((*wheels_mps)[0] + (*wheels_mps)[1]), stamp_utc_ns);
  const auto sign = direction(stamp_utc_ns);
  if (rear_mps && sign && settings_.track_m > 0.0 && !has_yaw_rate_)
    count(yaw_rate_.add(stamp_utc_ns, *sign * ((*rear_mps)[1] - (*rear_mps)[0]) / settings_.track_m));
}

std::optional<ndt::MeasuredMotion> Odometry::motion(std::int64_t from_utc_ns, std::int64_t to_utc_ns,
                                                    const ndt::Velocity& otherwise) const noexcept {
  if (to_utc_ns < from_utc_ns || to_utc_ns - from_utc_ns > kLongest_ns) return std::nullopt;
  bool has_speed = speed_.is_believed();
  bool has_yaw_rate = yaw_rate_.is_believed();
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  double speed_mps = otherwise[0];
  double rate_radps = otherwise[5];
  std::int64_t stamp_utc_ns = from_utc_ns;
  do {
    const std::int64_t step_ns = std::min(kStep_ns, to_utc_ns - stamp_utc_ns);
    const std::int64_t middle_utc_ns = stamp_utc_ns + step_ns / 2;
    const auto speed = has_speed ? speed_.at(middle_utc_ns) : std::nullopt;
    const auto rate = has_yaw_rate ? yaw_rate_.at(middle_utc_ns) : std::nullopt;
    // What falls silent on the way is left out from there on, and not believed for the whole.
    has_speed = speed.has_value();
    has_yaw_rate = rate.has_value();
    speed_mps = speed.value_or(speed_mps);
    rate_radps = rate.value_or(rate_radps);
    const double step_s = static_cast<double>(step_ns) * 1e-9;
    const double heading_rad = yaw_rad + 0.5 * rate_radps * step_s;
    x_m += speed_mps * step_s * std::cos(heading_rad);
    y_m += speed_mps * step_s * std::sin(heading_rad);
    yaw_rad += rate_radps * step_s;
    stamp_utc_ns += step_ns;
  } while (stamp_utc_ns < to_utc_ns);
  if (!has_speed && !has_yaw_rate) return std::nullopt;
  if (has_speed) speed_mps = speed_.at(to_utc_ns).value_or(speed_mps);
  if (has_yaw_rate) rate_radps = yaw_rate_.at(to_utc_ns).value_or(rate_radps);

  ndt::MeasuredMotion measured{.change = ndt::make_pose({x_m, y_m, 0.0}, {.yaw_rad = yaw_rad})};
  measured.velocity[0] = speed_mps;
  measured.velocity[1] = has_speed ? 0.0 : otherwise[1];
  measured.velocity[5] = rate_radps;
  if (has_speed && has_yaw_rate) measured.sigma_mps = std::hypot(kSigma_mps, speed_.error());
  return measured;
}

void Odometry::compare(std::int64_t from_utc_ns, std::int64_t to_utc_ns,
                       const ndt::Velocity& matched) noexcept {
  const auto compare_one = [&](OdometryChannel& channel, double matched_value) {
    // The mean over the sweep, by five times in it.
    constexpr std::int64_t kParts = 5;
    double sum = 0.0;
    for (std::int64_t part = 0; part < kParts; ++part) {
      const auto value = channel.at(from_utc_ns + (to_utc_ns - from_utc_ns) * (2 * part + 1) / (2 * kParts));
      if (!value) {
        channel.miss();
        ++counters_.silent;
        return;
      }
      sum += *value;
    }
    channel.compare(sum / static_cast<double>(kParts), matched_value);
  };
  if (settings_.count == 0) return;
  compare_one(speed_, matched[0]);
  compare_one(yaw_rate_, matched[5]);
}

OdometryCounters Odometry::counters() const noexcept {
  OdometryCounters counters = counters_;
  counters.times_left_out = speed_.times_left_out() + yaw_rate_.times_left_out();
  return counters;
}

}  // namespace landfix::platform
