#include "platform/latency_histogram.hpp"

#include <cmath>

namespace landfix::platform {

void LatencyHistogram::merge(const LatencyHistogram& other) noexcept {
  for (std::size_t i = 0; i < kCounters; ++i) counts_[i] += other.counts_[i];
  count_ += other.count_;
  max_ns_ = std::max<std::uint64_t>(max_ns_, other.max_ns_);
}

std::int64_t LatencyHistogram::percentile_ns(double percent) const noexcept {
  const double share = std::clamp(percent, 0.0, 100.0) / 100.0;
  const auto rank =
      std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_))));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < kCounters; ++i) {
    seen += counts_[i];
    if (seen >= rank) return std::min(highest(i), max_ns());
  }
  return max_ns();
}

}  // namespace landfix::platform
