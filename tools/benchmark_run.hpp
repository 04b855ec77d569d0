// What `landfix benchmark` measures: many starts from around the true pose of each scan, or a drive in order;
// and, where asked, what PCL makes of the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ndt/map_image.hpp"
#include "ndt/pose.hpp"
#include "ndt/scan_filter.hpp"
#include "ndt/voxel_map.hpp"
#include "tools/benchmark_statistics.hpp"
#include "tools/input_files.hpp"
#include "tools/pcl_rival.hpp"

namespace landfix::tools {

struct BenchmarkSettings {
  std::size_t starts = 20;       ///< a scan
  std::size_t rival_starts = 5;  ///< of them, those that the rival is given too
  double perturb_m = 0.5;        ///< distance of a start from the truth
  double perturb_rad = 0.0349;   ///< angle of its rotation from the truth's, about any axis
  bool perturb_exactly = false;  ///< the full amounts, not up to them
  bool in_sequence = false;      ///< one start a scan, where the two poses before lead to
  ndt::FilterSettings filter;
  RangeLimits limits;
  std::uint64_t seed = 1;
};

/// How one matcher did.
struct Performance {
  double points_mean = 0.0;  ///< after the filter
  std::vector<BenchmarkSample> samples;
  std::vector<double> match_cpu_ms;   ///< a start
  std::vector<double> filter_cpu_ms;  ///< a scan
  std::vector<double> build_cpu_ms;   ///< a build of the map; none where the map came as a file
};

/// The rival's time over ours, pair by pair.
struct TimeRatios {
  std::vector<double> match;
  std::vector<double> filter;
  std::vector<double> build;
};

struct BenchmarkResult {
  std::size_t scans = 0;
  Performance ours;
  Performance rival;
  TimeRatios ratios;
};

/// Builds the map of `points_m` and times it; with a rival, several times in turn with the rival's.
[[nodiscard]] ndt::MapImage build_timed(std::span<const Eigen::Vector3d> points_m, double resolution_m,
                                        PclRival* rival, BenchmarkResult& result);

/// `truth`: map <- vehicle, one for each of `scans`. `rival`: with its map built, or null. The same seed
/// gives the same starts. Adds to `result`.
void run_benchmark(const ndt::VoxelMap& map, std::span<const std::filesystem::path> scans,
                   std::span<const ndt::StampedPose> truth, const BenchmarkSettings& settings,
                   PclRival* rival, BenchmarkResult& result);

}  // namespace landfix::tools
