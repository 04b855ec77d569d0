#include "drivers/sensor_clock.hpp"

#include <algorithm>
#include <cstdlib>

namespace landfix::drivers {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kHourNs = 3600 * kSecondNs;
constexpr std::int64_t kSynchronisedWithinNs = 10 * kSecondNs;
/// Receive times are late by less than this; more is a clock that was set.
constexpr std::int64_t kJumpNs = kSecondNs / 2;
/// A packet out of order goes back by less than this.
constexpr std::int64_t kStepBackNs = kSecondNs / 100;
constexpr std::int64_t kDriftPerNs = 10'000;  // 100 ppm

/// Receive times come from captures: nothing is said about them.
constexpr std::int64_t bounded(std::int64_t receive_utc_ns) noexcept {
  return std::clamp<std::int64_t>(receive_utc_ns, 0, SensorClock::kLatestNs);
}

/// The nearest time to `near_ns`, not before 1970, at which the clock shows `microseconds`.
constexpr std::int64_t nearest(std::uint32_t microseconds, std::int64_t near_ns) noexcept {
  const std::int64_t hour_ns = near_ns / kHourNs * kHourNs;
  const std::int64_t time_ns = hour_ns + std::int64_t{microseconds} * 1000;
  if (time_ns - near_ns > kHourNs / 2 && time_ns >= kHourNs) return time_ns - kHourNs;
  if (near_ns - time_ns > kHourNs / 2) return time_ns + kHourNs;
  return time_ns;
}

}  // namespace

std::int64_t SensorClock::expand_top_of_hour(std::uint32_t microseconds,
                                             std::int64_t receive_utc_ns) const noexcept {
  const std::int64_t time_ns = nearest(microseconds, expected_ns(receive_utc_ns));
  return continues(time_ns, receive_utc_ns) ? time_ns : nearest(microseconds, bounded(receive_utc_ns));
}

std::int64_t SensorClock::expected_ns(std::int64_t receive_utc_ns) const noexcept {
  const std::int64_t received_ns = bounded(receive_utc_ns);
  return started_ ? last_sensor_ns_ + (received_ns - last_receive_utc_ns_) : received_ns;
}

bool SensorClock::continues(std::int64_t sensor_ns, std::int64_t receive_utc_ns) const noexcept {
  if (!started_) return true;
  return std::abs(sensor_ns - expected_ns(receive_utc_ns)) <= kJumpNs &&
         last_sensor_ns_ - sensor_ns <= kStepBackNs;
}

bool SensorClock::advance(std::int64_t sensor_ns, std::int64_t receive_utc_ns) noexcept {
  const std::int64_t ahead_ns = bounded(receive_utc_ns) - sensor_ns;
  const bool jumped = !continues(sensor_ns, receive_utc_ns);
  if (!started_ || jumped) {
    synchronised_ = std::abs(ahead_ns) <= kSynchronisedWithinNs;
    offset_ns_ = synchronised_ ? 0 : ahead_ns;
  } else if (!synchronised_) {
    const std::int64_t elapsed_ns = std::max<std::int64_t>(0, sensor_ns - last_sensor_ns_);
    offset_ns_ = std::min(offset_ns_ + elapsed_ns / kDriftPerNs, ahead_ns);
  }
  started_ = true;
  last_sensor_ns_ = sensor_ns;
  last_receive_utc_ns_ = bounded(receive_utc_ns);
  return jumped;
}

}  // namespace landfix::drivers
