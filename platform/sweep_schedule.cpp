#include "platform/sweep_schedule.hpp"

#include <algorithm>

namespace landfix::platform {
namespace {

// Of all sensors there are: 5 to 20 Hz, and what a motor may be off by.
constexpr std::int64_t kShortestPeriod_ns = 40'000'000;
constexpr std::int64_t kLongestPeriod_ns = 250'000'000;
constexpr std::int64_t kSilencePeriod_ns = 500'000'000;
/// Packets may be told a little out of order; what goes back farther is a clock that was set.
constexpr std::int64_t kSetBack_ns = 500'000'000;
/// Of silence, ten years: what is longer is no time, and would overflow.
constexpr std::int64_t kTenYears_ns = 315'360'000'000'000'000;

/// Stamps in a capture may be any number.
[[nodiscard]] std::int64_t wrapped_difference(std::int64_t a, std::int64_t b) noexcept {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

[[nodiscard]] std::int64_t wrapped_sum(std::int64_t a, std::int64_t b) noexcept {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

}  // namespace

void SweepSchedule::came(std::int64_t stamp_utc_ns, std::int64_t received_utc_ns) noexcept {
  if (any_) learn_period(wrapped_difference(stamp_utc_ns, last_stamp_utc_ns_));
  any_ = true;
  clock_offset_ns_ = offsets_ns_.add(wrapped_difference(received_utc_ns, stamp_utc_ns));
  last_stamp_utc_ns_ = stamp_utc_ns;
  last_received_utc_ns_ = received_utc_ns;
  newest_utc_ns_ = received_utc_ns;
  missing_ = 0;
}

std::int64_t SweepSchedule::received(std::int64_t stamp_utc_ns) const noexcept {
  return wrapped_sum(stamp_utc_ns, clock_offset_ns_);
}

void SweepSchedule::learn_period(std::int64_t between_ns) noexcept {
  if (between_ns < kShortestPeriod_ns || between_ns > kLongestPeriod_ns) return;
  period_ns_ = periods_ns_.add(between_ns);
}

void SweepSchedule::follow_clock(std::int64_t now_utc_ns) noexcept {
  const std::int64_t ahead_ns = wrapped_difference(now_utc_ns, newest_utc_ns_);
  if (ahead_ns < 0 && ahead_ns > -kSetBack_ns) return;
  // Set back, as if no time had passed: else a silence would be noticed only when the clock has caught up.
  if (ahead_ns < 0) last_received_utc_ns_ = wrapped_sum(last_received_utc_ns_, ahead_ns);
  newest_utc_ns_ = now_utc_ns;
}

std::optional<MissingSweep> SweepSchedule::next_missing(std::int64_t now_utc_ns) noexcept {
  if (!any_) return std::nullopt;
  follow_clock(now_utc_ns);
  const std::int64_t since_ns =
      std::min(wrapped_difference(now_utc_ns, last_received_utc_ns_), kTenYears_ns) - period_ns_ / 2;
  const std::int64_t overdue = since_ns / period_ns_;
  if (overdue <= missing_) return std::nullopt;

  const bool was_silence = missing_ * period_ns_ > silent_after_ns_;
  const bool is_silence = (missing_ + 1) * period_ns_ > silent_after_ns_;
  if (was_silence && overdue - missing_ < kSilencePeriod_ns / period_ns_) return std::nullopt;
  missing_ = is_silence ? overdue : missing_ + 1;
  return MissingSweep{.stamp_utc_ns = wrapped_sum(last_stamp_utc_ns_, missing_ * period_ns_),
                      .is_silence = is_silence};
}

}  // namespace landfix::platform
