#include "tools/benchmark_statistics.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace landfix::tools {
namespace {

TEST(Quantile, IsTheNearestRankOfAnyOrder) {
  const std::vector<double> values{5.0, 1.0, 4.0, 2.0, 3.0};
  EXPECT_EQ(quantile(values, 0.0), 1.0);
  EXPECT_EQ(quantile(values, 0.2), 1.0);
  EXPECT_EQ(quantile(values, 0.21), 2.0);
  EXPECT_EQ(quantile(values, 0.5), 3.0);
  EXPECT_EQ(quantile(values, 0.99), 5.0);
  EXPECT_EQ(quantile(values, 1.0), 5.0);
  EXPECT_EQ(quantile({7.0}, 0.99), 7.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(BenchmarkSample, HoldsTheErrorAlongTheVehiclesAxes) {
  ndt::Pose truth = ndt::make_pose({100.0, 50.0, 1.0}, {.yaw_rad = 90.0 * ndt::kRadians_per_deg});
  ndt::Pose found = truth;
  found.translation() += Eigen::Vector3d(0.0, 0.05, 0.0);  // north, where the vehicle looks
  found.linear() = truth.linear() * ndt::rotation_exp({0.0, 0.0, 0.003});
  const BenchmarkSample sample = compare(found, truth, 7);
  EXPECT_NEAR((sample.error_m - Eigen::Vector3d(0.05, 0.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(sample.error_rad, 0.003, 1e-9);
  EXPECT_EQ(sample.iterations, 7);
}

TEST(BenchmarkSample, IsOkWithinTenCentimetresAndHalfADegree) {
  constexpr double kLess_rad = 0.49 * ndt::kRadians_per_deg;
  constexpr double kMore_rad = 0.51 * ndt::kRadians_per_deg;
  EXPECT_TRUE((BenchmarkSample{.error_m = {0.05, 0.05, 0.05}, .error_rad = kLess_rad}.ok()));
  EXPECT_FALSE((BenchmarkSample{.error_m = {0.05, 0.05, 0.05}, .error_rad = kMore_rad}.ok()));
  EXPECT_FALSE((BenchmarkSample{.error_m = {0.08, 0.08, 0.0}, .error_rad = kLess_rad}.ok()));
  EXPECT_FALSE((BenchmarkSample{.error_m = {std::nan(""), 0.0, 0.0}}.ok()));
}

TEST(BenchmarkSummary, CountsFailedStartsInEverything) {
  const std::vector<BenchmarkSample> samples{
      {.error_m = {0.01, 0.0, 0.0}, .error_rad = 0.001, .iterations = 4},
      {.error_m = {0.03, 0.0, 0.0}, .error_rad = 0.002, .iterations = 6},
      {.error_m = {0.00, 0.0, 2.0}, .error_rad = 0.003, .iterations = 50},
      {.error_m = {0.02, 0.0, 0.0}, .error_rad = 0.004, .iterations = 4},
  };
  const Summary summary = summarise(samples);
  EXPECT_DOUBLE_EQ(summary.ok_percent, 75.0);
  EXPECT_NEAR(summary.error_median_cm, 2.0, 1e-12);
  EXPECT_NEAR(summary.error_p95_cm, 200.0, 1e-12);
  EXPECT_NEAR(summary.error_median_deg, 0.002 / ndt::kRadians_per_deg, 1e-12);
  EXPECT_NEAR(summary.error_p95_deg, 0.004 / ndt::kRadians_per_deg, 1e-12);
  EXPECT_DOUBLE_EQ(summary.iterations_mean, 16.0);
  EXPECT_NEAR(summary.bias_cm, 100.0 * std::hypot(0.06, 2.0) / 4.0, 1e-9);
  EXPECT_NEAR(summary.bias_ok_cm, 2.0, 1e-12);
}

TEST(BenchmarkSummary, HasNoBiasWhereErrorsAverageOut) {
  const std::vector<BenchmarkSample> samples{
      {.error_m = {0.03, -0.02, 0.0}}, {.error_m = {-0.03, 0.0, 0.01}}, {.error_m = {0.0, 0.02, -0.01}}};
  EXPECT_NEAR(summarise(samples).bias_cm, 0.0, 1e-12);
  EXPECT_GT(summarise(samples).error_median_cm, 2.0);
}

TEST(BenchmarkSummary, OfNothingIsNotANumber) {
  EXPECT_TRUE(std::isnan(summarise({}).ok_percent));
  EXPECT_TRUE(std::isnan(summarise({}).bias_cm));
  const std::vector<BenchmarkSample> failed{{.error_m = {1.0, 0.0, 0.0}}};
  EXPECT_TRUE(std::isnan(summarise(failed).bias_ok_cm));
}

}  // namespace
}  // namespace landfix::tools
