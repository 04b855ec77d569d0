// What became of a drive on which something went wrong: how far off it was while it said TRACKING, and when
// it was found again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ndt/localizer.hpp"
#include "ndt/pose.hpp"
#include "platform/sweep_result.hpp"
#include "platform/trajectory.hpp"

namespace landfix::test {

struct DriveVerdict {
  double worst_m = 0.0;    ///< while TRACKING
  double worst_deg = 0.0;  ///< while TRACKING
  std::optional<double> recovery_s;
  bool ends_tracking = false;          ///< with the last whole sweep
  std::size_t sweeps_to_tracking = 0;  ///< that came after the fault, until one was TRACKING
};

/// `until_utc_ns`: the end of the fault. `leap_ns`: of the stamps, farther than the drive is long.
[[nodiscard]] inline DriveVerdict judge_drive(std::span<const platform::SweepResult> sweeps,
                                              const std::vector<ndt::StampedPose>& truth,
                                              std::int64_t until_utc_ns, std::int64_t leap_ns = 0) {
  DriveVerdict verdict;
  for (const platform::SweepResult& sweep : sweeps) {
    std::int64_t stamp_utc_ns = sweep.fix.at.stamp_utc_ns;
    if (!platform::interpolate(truth, stamp_utc_ns)) stamp_utc_ns -= leap_ns;
    const auto there = platform::interpolate(truth, stamp_utc_ns);
    const double after_s = static_cast<double>(stamp_utc_ns - until_utc_ns) * 1e-9;
    const bool is_tracking = sweep.fix.state == ndt::State::tracking;
    if (!sweep.missing && after_s > 0.0 && !verdict.recovery_s) {
      ++verdict.sweeps_to_tracking;
      if (is_tracking) verdict.recovery_s = after_s;
    }
    if (sweep.complete && there) verdict.ends_tracking = is_tracking;
    if (!is_tracking || !there) continue;
    const double error_m = (sweep.fix.at.pose.translation() - there->translation()).norm();
    const double error_deg = ndt::angle_between(sweep.fix.at.pose, *there) / ndt::kRadians_per_deg;
    verdict.worst_m = std::max(verdict.worst_m, error_m);
    verdict.worst_deg = std::max(verdict.worst_deg, error_deg);
  }
  return verdict;
}

}  // namespace landfix::test
