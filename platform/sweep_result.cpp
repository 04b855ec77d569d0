#include "platform/sweep_result.hpp"

#include <algorithm>

namespace landfix::platform {

PoseReport report_of(const SweepResult& result) noexcept {
  constexpr double kOldest_s = 6.5;  // what is older is told as this old: the signal holds 6.5534 s
  PoseReport report = report_of(result.fix, result.time_source, result.complete);
  const double age_s = static_cast<double>(result.fix.at.stamp_utc_ns - result.seen_utc_ns) * 1e-9;
  report.age_s = std::min(age_s, kOldest_s);
  return report;
}

}  // namespace landfix::platform
