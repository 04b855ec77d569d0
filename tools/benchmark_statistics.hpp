// What `landfix benchmark` says of many starts. Failed ones count like all others.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "ndt/pose.hpp"

namespace landfix::tools {

/// One start.
struct BenchmarkSample {
  Eigen::Vector3d error_m = Eigen::Vector3d::Zero();  ///< found - true, along the true vehicle's axes
  double error_rad = 0.0;                             ///< angle of the rotation between the two
  int iterations = 0;

  [[nodiscard]] bool ok() const noexcept;  ///< within 0.1 m and 0.5 deg of the truth
};

[[nodiscard]] BenchmarkSample compare(const ndt::Pose& found, const ndt::Pose& truth, int iterations);

struct Summary {
  double ok_percent = 0.0;
  double error_median_cm = 0.0;
  double error_p95_cm = 0.0;
  double error_median_deg = 0.0;
  double error_p95_deg = 0.0;
  double bias_cm = 0.0;     ///< length of the mean error: what does not average out
  double bias_ok_cm = 0.0;  ///< the same of the starts that are ok
  double iterations_mean = 0.0;
};

/// NaN of no samples.
[[nodiscard]] Summary summarise(std::span<const BenchmarkSample> samples);

/// The p-th quantile of a sample, p in [0, 1], by nearest rank; NaN of none.
[[nodiscard]] double quantile(std::vector<double> values, double p);

}  // namespace landfix::tools
