// What came of one sweep, and how the bus is told.
#pragma once

#include <cstddef>
#include <cstdint>

#include "drivers/sweep.hpp"
#include "ndt/localizer.hpp"
#include "platform/pose_report.hpp"

namespace landfix::platform {

/// When a sweep's stages ended, by the monotonic clock; 0 where there was none.
struct SweepTimes {
  std::int64_t first_packet_ns = 0;  ///< when its first packet was taken up
  std::int64_t last_packet_ns = 0;   ///< when its last one was
  std::int64_t filtered_ns = 0;
  std::int64_t matched_ns = 0;
};

/// Of a sweep, or of one that did not come.
struct SweepResult {
  ndt::Fix fix;
  std::int64_t seen_utc_ns = 0;  ///< the stamp of the last sweep that came: this one's, unless it is missing
  bool missing = false;          ///< it has not come: predicted, or NO_DATA
  bool late = false;             ///< it has come after a later one was predicted: its pose is not news
  bool skipped = false;          ///< it has come, but was not matched as newer ones were waiting: predicted
  std::size_t points_filtered = 0;  ///< that were matched
  bool complete = false;
  drivers::TimeSource time_source = drivers::TimeSource::receive;
  SweepTimes times{};
};

/// As it is sent when it is made.
[[nodiscard]] PoseReport report_of(const SweepResult& result) noexcept;

}  // namespace landfix::platform
