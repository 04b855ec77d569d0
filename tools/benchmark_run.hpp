// What `landfix benchmark` measures: many starts from around the true pose of each scan, or a drive in order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ndt/matcher.hpp"
#include "ndt/pose.hpp"
#include "ndt/voxel_map.hpp"
#include "tools/input_files.hpp"

namespace landfix::tools {

struct BenchmarkSettings {
  std::size_t starts = 20;       ///< a scan
  double perturb_m = 0.5;        ///< distance of a start from the truth
  double perturb_rad = 0.0349;   ///< angle of its rotation from the truth's, about any axis
  bool perturb_exactly = false;  ///< the full amounts, not up to them
  bool in_sequence = false;      ///< one start a scan, where the two poses before lead to
  ndt::FilterSettings filter;
  RangeLimits limits;
  std::uint64_t seed = 1;
};

/// One start.
struct BenchmarkSample {
  double error_m = 0.0;
  double error_rad = 0.0;
  int iterations = 0;
  double match_cpu_ms = 0.0;

  [[nodiscard]] bool ok() const noexcept;  ///< within 0.1 m and 0.5 deg of the truth
};

struct BenchmarkResult {
  std::size_t scans = 0;
  double points_mean = 0.0;  ///< after the filter
  std::vector<BenchmarkSample> samples;
  std::vector<double> filter_cpu_ms;  ///< a scan
};

/// `truth`: map <- vehicle, one for each of `scans`. The same seed gives the same starts.
[[nodiscard]] BenchmarkResult run_benchmark(const ndt::VoxelMap& map,
                                            std::span<const std::filesystem::path> scans,
                                            std::span<const ndt::StampedPose> truth,
                                            const BenchmarkSettings& settings);

/// The p-th quantile of a sample, p in [0, 1], by nearest rank; NaN of none.
[[nodiscard]] double quantile(std::vector<double> values, double p);

}  // namespace landfix::tools
