#include "tools/benchmark_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace landfix::tools {
namespace {

constexpr double kOk_m = 0.1;
constexpr double kOk_rad = 0.5 * ndt::kRadians_per_deg;

}  // namespace

bool BenchmarkSample::ok() const noexcept { return error_m.norm() <= kOk_m && error_rad <= kOk_rad; }

BenchmarkSample compare(const ndt::Pose& found, const ndt::Pose& truth, int iterations) {
  return {.error_m = truth.linear().transpose() * (found.translation() - truth.translation()),
          .error_rad = ndt::angle_between(found, truth),
          .iterations = iterations};
}

Summary summarise(std::span<const BenchmarkSample> samples) {
  std::vector<double> error_cm;
  std::vector<double> error_deg;
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_ok_m = Eigen::Vector3d::Zero();
  double iterations = 0.0;
  std::size_t ok = 0;
  for (const BenchmarkSample& sample : samples) {
    error_cm.push_back(100.0 * sample.error_m.norm());
    error_deg.push_back(sample.error_rad / ndt::kRadians_per_deg);
    sum_m += sample.error_m;
    iterations += sample.iterations;
    if (!sample.ok()) continue;
    ++ok;
    sum_ok_m += sample.error_m;
  }
  const auto count = static_cast<double>(samples.size());
  const auto ok_count = static_cast<double>(ok);
  return {.ok_percent = 100.0 * ok_count / count,
          .error_median_cm = quantile(error_cm, 0.5),
          .error_p95_cm = quantile(error_cm, 0.95),
          .error_median_deg = quantile(error_deg, 0.5),
          .error_p95_deg = quantile(error_deg, 0.95),
          .bias_cm = 100.0 * sum_m.norm() / count,
          .bias_ok_cm = 100.0 * sum_ok_m.norm() / ok_count,
          .iterations_mean = iterations / count};
}

double quantile(std::vector<double> values, double p) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(p * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace landfix::tools
