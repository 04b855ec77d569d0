#include "platform/hgrm.hpp"

#include <cmath>
#include <memory>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/error_of.hpp"

namespace landfix::platform {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// 10,000 values around 0.5 ms.
std::unique_ptr<LatencyHistogram> some_latencies() {
  std::mt19937_64 random(1);
  std::lognormal_distribution<double> duration_ns(13.1, 0.4);
  auto histogram = std::make_unique<LatencyHistogram>();
  for (int i = 0; i < 10'000; ++i) histogram->record(static_cast<std::int64_t>(duration_ns(random)));
  return histogram;
}

/// As HdrHistogram's Java writes it: 1, 2, ... 10 ms.
constexpr const char* kOfJava =
    "       Value     Percentile TotalCount 1/(1-Percentile)\n\n"
    "       1.000 0.000000000000          1           1.00\n"
    "       5.000 0.500000000000          5           2.00\n"
    "       9.000 0.900000000000          9          10.00\n"
    "      10.003 0.950000000000         10          20.00\n"
    "      10.003 1.000000000000         10\n"
    "#[Mean    =        5.500, StdDeviation   =        2.872]\n"
    "#[Max     =       10.000, Total count    =           10]\n"
    "#[Buckets =           17, SubBuckets     =         2048]\n";

TEST(Hgrm, ReadsBackWhatWasMeasured) {
  const auto histogram = some_latencies();
  const LatencyDistribution written = distribution_of(*histogram, "match");
  const LatencyDistribution read = parse_hgrm(to_hgrm(written), "match.hgrm");
  EXPECT_EQ(read.stage, "match");
  EXPECT_EQ(read.count(), histogram->count());
  EXPECT_NEAR(read.mean_ms, written.mean_ms, 1e-6);
  EXPECT_NEAR(read.deviation_ms, written.deviation_ms, 1e-6);
  for (double percent = 0.0; percent <= 100.0; percent += 0.1) {
    const double exact_ms = 1e-6 * static_cast<double>(histogram->percentile_ns(percent));
    EXPECT_NEAR(read.percentile_ms(percent), exact_ms, 1e-6) << percent;
  }
  EXPECT_NEAR(read.max_ms, 1e-6 * static_cast<double>(histogram->max_ns()), 1e-9);
}

TEST(Hgrm, MeanAndDeviationAreTheValues) {
  LatencyHistogram histogram;
  for (const std::int64_t value_ns : {100, 200, 100, 200}) histogram.record(value_ns);
  const LatencyDistribution distribution = distribution_of(histogram, "decode");
  EXPECT_NEAR(distribution.mean_ms, 150e-6, 1e-12);
  EXPECT_NEAR(distribution.deviation_ms, 50e-6, 1e-12);
}

TEST(Hgrm, HasTheColumnsOfHdrHistogram) {
  LatencyHistogram histogram;
  histogram.record(100);
  histogram.record(200);
  EXPECT_EQ(to_hgrm(distribution_of(histogram, "total")),
            "       Value     Percentile TotalCount 1/(1-Percentile)\n\n"
            "    0.000100 0.500000000000          1           2.00\n"
            "    0.000200 1.000000000000          2\n"
            "#[Mean    =     0.000150, StdDeviation   =     0.000050]\n"
            "#[Max     =     0.000200, Total count    =            2]\n"
            "#[Buckets =           29, SubBuckets     =          256]\n"
            "#[Stage   = total]\n");
}

TEST(Hgrm, ReadsWhatHdrHistogramWrites) {
  const LatencyDistribution read = parse_hgrm(kOfJava, "java.hgrm");
  EXPECT_EQ(read.stage, "");
  EXPECT_EQ(read.count(), 10U);
  EXPECT_DOUBLE_EQ(read.percentile_ms(50.0), 5.0);
  EXPECT_DOUBLE_EQ(read.percentile_ms(90.0), 9.0);
  EXPECT_DOUBLE_EQ(read.mean_ms, 5.5);
}

TEST(Hgrm, OfNothingIsReadBack) {
  const LatencyDistribution read = parse_hgrm(to_hgrm(distribution_of({}, "total")), "none.hgrm");
  EXPECT_EQ(read.count(), 0U);
  EXPECT_TRUE(std::isnan(read.percentile_ms(50.0)));
}

TEST(Hgrm, SaysInWhichLineItIsWrong) {
  const auto error = [](const std::string& text) {
    return test::error_of([&text] { return parse_hgrm(text, "x.hgrm"); });
  };
  EXPECT_THAT(error("hello\n"), StartsWith("x.hgrm:1: expected the title"));
  EXPECT_THAT(error(""), HasSubstr("no title"));
  const std::string title = "Value Percentile TotalCount 1/(1-Percentile)\n\n";
  for (const char* const line : {"1 0.5\n", "1 0.5 x 2\n", "nan 0.5 1\n", "-1 0.5 1\n", "1 0.5 -1\n"}) {
    EXPECT_THAT(error(title + line), StartsWith("x.hgrm:3: expected value")) << line;
  }
  EXPECT_THAT(error(title + "2 0.5 1\n1 1.0 2\n"), StartsWith("x.hgrm:4: "));
}

}  // namespace
}  // namespace landfix::platform
