// Latencies in fixed memory: counters whose width grows with the value, 128 to every power of two, so that a
// percentile is right to 1/128 from nanoseconds to a minute (Gil Tene's HdrHistogram).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "platform/relaxed_counter.hpp"

namespace landfix::platform {

/// Values from 0 to 68 s in nanoseconds; beyond, and below, they count as the nearest of these. 31 KB. One
/// thread records; any other may read at the same time, and misses at most what is being recorded.
class LatencyHistogram {
 public:
  static constexpr std::int64_t kMaxValue_ns = (std::int64_t{1} << 36) - 1;

  void record(std::int64_t value_ns) noexcept {
    const auto value = static_cast<std::uint64_t>(std::clamp(value_ns, std::int64_t{0}, kMaxValue_ns));
    ++counts_[index(value)];
    ++count_;
    max_ns_ = std::max<std::uint64_t>(max_ns_, value);
  }

  /// As if all that the other recorded had been recorded here.
  void merge(const LatencyHistogram& other) noexcept;

  void clear() noexcept { *this = {}; }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// Exact.
  [[nodiscard]] std::int64_t max_ns() const noexcept { return static_cast<std::int64_t>(max_ns_); }

  /// The smallest value that `percent` of the values do not exceed, rounded up by less than 0.8 %; 0 if there
  /// are none. `percent` within [0, 100].
  [[nodiscard]] std::int64_t percentile_ns(double percent) const noexcept;

  /// Calls `visit(largest value that shares it, values)` for every counter that counts some, in rising order.
  template <class Visit>
  void visit_counters(Visit visit) const {
    for (std::size_t i = 0; i < kCounters; ++i) {
      const std::uint64_t values = counts_[i];
      if (values != 0) visit(highest(i), values);
    }
  }

  // HdrHistogram's own names of its size.
  static constexpr unsigned kBuckets = 29;
  static constexpr unsigned kSubBucketCount = 256;

 private:
  static constexpr unsigned kSubBucketBits = 7;
  static constexpr std::size_t kSubBuckets = std::size_t{1} << kSubBucketBits;
  static constexpr unsigned kValueBits = 36;
  static constexpr std::size_t kCounters = (kValueBits - kSubBucketBits + 1) * kSubBuckets;

  /// The leading one and the 7 bits behind it choose the counter; values below 256 have one each.
  [[nodiscard]] static constexpr std::size_t index(std::uint64_t value) noexcept {
    const auto dropped =
        static_cast<unsigned>(std::bit_width(value | (2 * kSubBuckets - 1))) - kSubBucketBits - 1;
    return std::size_t{dropped} * kSubBuckets + static_cast<std::size_t>(value >> dropped);
  }
  /// The largest value that shares the counter.
  [[nodiscard]] static constexpr std::int64_t highest(std::size_t index) noexcept {
    if (index < 2 * kSubBuckets) return static_cast<std::int64_t>(index);
    const std::size_t dropped = index / kSubBuckets - 1;
    return static_cast<std::int64_t>((((index % kSubBuckets + kSubBuckets) + 1) << dropped) - 1);
  }

  static_assert(kBuckets == kValueBits - kSubBucketBits && kSubBucketCount == 2 * kSubBuckets);

  std::array<RelaxedCounter, kCounters> counts_{};
  RelaxedCounter count_;
  RelaxedCounter max_ns_;
};

}  // namespace landfix::platform
