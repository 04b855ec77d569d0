#include "platform/latency_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace landfix::platform {
namespace {

std::int64_t exact_percentile(const std::vector<std::int64_t>& sorted, double percent) {
  const double rank = std::ceil(percent / 100.0 * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

TEST(LatencyHistogram, PercentilesAreRightToEightPerMille) {
  std::mt19937_64 random(1);
  // From a nanosecond to a minute, evenly over the orders of magnitude.
  std::uniform_real_distribution<double> exponent(0.0, 10.8);
  const auto histogram = std::make_unique<LatencyHistogram>();
  std::vector<std::int64_t> values;
  for (int i = 0; i < 100000; ++i) {
    values.push_back(static_cast<std::int64_t>(std::pow(10.0, exponent(random))));
    histogram->record(values.back());
  }
  std::sort(values.begin(), values.end());
  for (const double percent : {0.0, 0.1, 1.0, 10.0, 50.0, 90.0, 99.0, 99.9, 99.99, 100.0}) {
    const std::int64_t exact = exact_percentile(values, percent);
    EXPECT_GE(histogram->percentile_ns(percent), exact) << percent;
    EXPECT_LE(static_cast<double>(histogram->percentile_ns(percent)), static_cast<double>(exact) * 1.008)
        << percent;
  }
  EXPECT_EQ(histogram->max_ns(), values.back());
  EXPECT_EQ(histogram->percentile_ns(100.0), values.back());
  EXPECT_EQ(histogram->count(), values.size());
}

TEST(LatencyHistogram, SmallValuesAreExact) {
  const auto histogram = std::make_unique<LatencyHistogram>();
  for (std::int64_t value = 0; value < 256; ++value) histogram->record(value);
  EXPECT_EQ(histogram->percentile_ns(50.0), 127);
  EXPECT_EQ(histogram->percentile_ns(0.0), 0);
  EXPECT_EQ(histogram->percentile_ns(100.0), 255);
}

TEST(LatencyHistogram, WhatIsOutOfRangeCountsAtTheEnds) {
  const auto histogram = std::make_unique<LatencyHistogram>();
  histogram->record(-5);
  EXPECT_EQ(histogram->percentile_ns(100.0), 0);
  histogram->record(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(histogram->max_ns(), LatencyHistogram::kMaxValue_ns);
  EXPECT_EQ(histogram->percentile_ns(100.0), LatencyHistogram::kMaxValue_ns);
  EXPECT_EQ(histogram->count(), 2U);
}

TEST(LatencyHistogram, AnEmptyOneHasNothingToSay) {
  const auto histogram = std::make_unique<LatencyHistogram>();
  EXPECT_EQ(histogram->percentile_ns(99.0), 0);
  EXPECT_EQ(histogram->max_ns(), 0);
}

TEST(LatencyHistogram, MergingIsRecordingInOne) {
  std::mt19937_64 random(2);
  const auto a = std::make_unique<LatencyHistogram>();
  const auto b = std::make_unique<LatencyHistogram>();
  const auto both = std::make_unique<LatencyHistogram>();
  for (int i = 0; i < 1000; ++i) {
    const auto value = static_cast<std::int64_t>(random() % 1'000'000);
    (i % 3 == 0 ? a : b)->record(value);
    both->record(value);
  }
  a->merge(*b);
  EXPECT_EQ(a->count(), both->count());
  EXPECT_EQ(a->max_ns(), both->max_ns());
  for (double percent = 0.0; percent <= 100.0; percent += 2.5) {
    EXPECT_EQ(a->percentile_ns(percent), both->percentile_ns(percent));
  }
  a->clear();
  EXPECT_EQ(a->count(), 0U);
}

}  // namespace
}  // namespace landfix::platform
