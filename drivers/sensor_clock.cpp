#include "drivers/sensor_clock.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

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

std::int64_t nearest(std::uint32_t microseconds, std::int64_t near_ns) noexcept {
  return nearest_after_hour(std::int64_t{microseconds} * 1000, near_ns);
}

}  // namespace

std::int64_t nearest_after_hour(std::int64_t after_hour_ns, std::int64_t near_ns) noexcept {
  const std::int64_t time_ns = near_ns / kHourNs * kHourNs + after_hour_ns;
  if (time_ns - near_ns > kHourNs / 2 && time_ns >= kHourNs) return time_ns - kHourNs;
  if (near_ns - time_ns > kHourNs / 2) return time_ns + kHourNs;
  return time_ns;
}

std::int64_t SensorClock::reference_ns(std::int64_t receive_utc_ns) const noexcept {
  return bounded(bounded(receive_utc_ns) + reference_ns_);
}

std::int64_t SensorClock::expand_top_of_hour(std::uint32_t microseconds,
                                             std::int64_t receive_utc_ns) const noexcept {
  const std::int64_t time_ns = nearest(microseconds, expected_ns(receive_utc_ns));
  return continues(time_ns, receive_utc_ns) ? time_ns : nearest(microseconds, reference_ns(receive_utc_ns));
}

std::int64_t SensorClock::expected_ns(std::int64_t receive_utc_ns) const noexcept {
  if (!started_) return reference_ns(receive_utc_ns);
  return last_.sensor_ns + (bounded(receive_utc_ns) - last_.receive_utc_ns);
}

bool SensorClock::continues(std::int64_t sensor_ns, std::int64_t receive_utc_ns) const noexcept {
  if (!started_) return true;
  return std::abs(sensor_ns - expected_ns(receive_utc_ns)) <= kJumpNs &&
         last_.sensor_ns - sensor_ns <= kStepBackNs;
}

void SensorClock::start(std::int64_t sensor_ns, std::int64_t receive_utc_ns) noexcept {
  synchronised_ = std::abs(reference_ns(receive_utc_ns) - sensor_ns) <= kSynchronisedWithinNs;
  offset_ns_ = synchronised_ ? 0 : bounded(receive_utc_ns) - sensor_ns;
  started_ = true;
}

ClockVerdict SensorClock::advance(std::int64_t sensor_ns, std::int64_t receive_utc_ns) noexcept {
  ClockVerdict verdict = ClockVerdict::continues;
  const Moment moment{.sensor_ns = sensor_ns, .receive_utc_ns = bounded(receive_utc_ns)};
  if (!started_) {
    start(sensor_ns, receive_utc_ns);
  } else if (!continues(sensor_ns, receive_utc_ns)) {
    // One packet is no witness: two that agree with each other are.
    const auto before = std::exchange(doubtful_, moment);
    if (!before) return ClockVerdict::doubtful;
    const std::int64_t since_ns = sensor_ns - before->sensor_ns;
    const std::int64_t received_since_ns = moment.receive_utc_ns - before->receive_utc_ns;
    if (since_ns < -kStepBackNs || std::abs(since_ns - received_since_ns) > kJumpNs) {
      return ClockVerdict::doubtful;
    }
    start(sensor_ns, receive_utc_ns);
    verdict = ClockVerdict::stepped;
  } else if (!synchronised_) {
    const std::int64_t elapsed_ns = std::max<std::int64_t>(0, sensor_ns - last_.sensor_ns);
    offset_ns_ = std::min(offset_ns_ + elapsed_ns / kDriftPerNs, moment.receive_utc_ns - sensor_ns);
  }
  doubtful_.reset();
  last_ = moment;
  return verdict;
}

bool SensorClock::learn_utc(std::int64_t sensor_utc_ns, std::int64_t receive_utc_ns) noexcept {
  sensor_utc_ns = bounded(sensor_utc_ns);
  reference_ns_ = sensor_utc_ns - bounded(receive_utc_ns);
  if (!started_) return false;
  // The count within the hour is the sensor's own; which hour was the receiver's guess.
  const std::int64_t off_ns = sensor_utc_ns - expected_ns(receive_utc_ns);
  const std::int64_t hours = (off_ns + (off_ns < 0 ? -kHourNs : kHourNs) / 2) / kHourNs;
  if (std::abs(off_ns - hours * kHourNs) > kSynchronisedWithinNs) return false;  // of another time: wait
  const bool changes = hours != 0 || !synchronised_;
  last_.sensor_ns += hours * kHourNs;
  synchronised_ = true;
  offset_ns_ = 0;
  return changes;
}

}  // namespace landfix::drivers
