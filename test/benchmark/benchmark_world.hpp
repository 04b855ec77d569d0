// What the benchmarks of matching run on: a yard that needs no data, and a real drive where LANDFIX_TEST_DATA
// has it.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "ndt/map_image.hpp"
#include "ndt/pose.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::test {

struct BenchmarkWorld {
  /// `surveyed_m`: frame `map`. `scan_m`: seen from `truth`.
  BenchmarkWorld(std::string name, std::vector<Eigen::Vector3d> surveyed_m,
                 std::vector<Eigen::Vector3f> scan_m, const ndt::Pose& truth);
  BenchmarkWorld(const BenchmarkWorld&) = delete;
  BenchmarkWorld& operator=(const BenchmarkWorld&) = delete;
  ~BenchmarkWorld() = default;

  /// The scan thinned to one point a cell.
  [[nodiscard]] std::vector<Eigen::Vector3f> thinned(double leaf_m) const;

  static constexpr double kResolution_m = 1.0;

  std::string name;
  std::vector<Eigen::Vector3d> surveyed_m;
  std::vector<Eigen::Vector3f> scan_m;
  ndt::Pose truth;
  ndt::Pose guess;  ///< 30 cm and 1 deg off
  ndt::MapImage image;
  ndt::VoxelMap map;
};

/// Those there are.
[[nodiscard]] const std::vector<const BenchmarkWorld*>& benchmark_worlds();

}  // namespace landfix::test
