#include "platform/engine_status.hpp"

#include <algorithm>

namespace landfix::platform {

DurationSummary summarise(const LatencyHistogram& histogram) {
  constexpr double kS_per_ns = 1e-9;
  DurationSummary summary;
  histogram.visit_counters([&summary](std::int64_t highest_ns, std::uint64_t values) {
    const double value_s = static_cast<double>(highest_ns) * kS_per_ns;
    summary.count += values;
    summary.sum_s += value_s * static_cast<double>(values);
    for (std::size_t i = kDurationBounds_s.size(); i-- > 0 && value_s <= kDurationBounds_s[i];) {
      summary.within[i] += values;
    }
  });
  if (summary.count == 0) return summary;
  constexpr std::array kPercents{50.0, 90.0, 99.0, 99.9};
  std::ranges::transform(kPercents, summary.percentiles_s.begin(), [&histogram](double percent) {
    return static_cast<double>(histogram.percentile_ns(percent)) * kS_per_ns;
  });
  summary.max_s = static_cast<double>(histogram.max_ns()) * kS_per_ns;
  return summary;
}

}  // namespace landfix::platform
