// When sweeps should come, and which have not: by their times of receipt, which may be by another clock than
// the sweeps' own stamps, and which may be set.
#pragma once

#include <cstdint>
#include <optional>

#include "platform/running_median.hpp"

namespace landfix::platform {

/// The stamp that a sweep would have had which has not come.
struct MissingSweep {
  std::int64_t stamp_utc_ns = 0;
  bool is_silence = false;  ///< none has come for longer than may be predicted
};

class SweepSchedule {
 public:
  /// `longest_period_ns`: of the sensor's speeds; what counts until two sweeps have shown theirs.
  SweepSchedule(std::int64_t longest_period_ns, std::int64_t silent_after_ns) noexcept
      : silent_after_ns_(silent_after_ns), period_ns_(longest_period_ns) {}

  /// A sweep has come: its stamp, and when its last packet was received.
  void came(std::int64_t stamp_utc_ns, std::int64_t received_utc_ns) noexcept;

  /// The next sweep that should have come by now, by half a period; to be asked until there is none. Stamps
  /// go on by whole periods from the last sweep's, so that they stay a regular grid. In a silence only the
  /// newest is told, at least twice a second. However far the clock leaps, a call is short and the answers
  /// are few.
  [[nodiscard]] std::optional<MissingSweep> next_missing(std::int64_t now_utc_ns) noexcept;

  /// When a sweep of this stamp was, or will be, received.
  [[nodiscard]] std::int64_t received(std::int64_t stamp_utc_ns) const noexcept;
  [[nodiscard]] std::int64_t period_ns() const noexcept { return period_ns_; }

 private:
  void learn_period(std::int64_t between_ns) noexcept;
  void follow_clock(std::int64_t now_utc_ns) noexcept;

  std::int64_t silent_after_ns_;
  std::int64_t period_ns_;
  std::int64_t clock_offset_ns_ = 0;
  RunningMedian<std::int64_t, 5> periods_ns_;  ///< bears a splinter of a sweep and a gap
  RunningMedian<std::int64_t, 5> offsets_ns_;  ///< bears a sweep that was ended late, by a gap
  std::int64_t last_stamp_utc_ns_ = 0;
  std::int64_t last_received_utc_ns_ = 0;
  std::int64_t newest_utc_ns_ = 0;  ///< the clock when it was last told
  std::int64_t missing_ = 0;        ///< since the last sweep that came
  bool any_ = false;
};

}  // namespace landfix::platform
