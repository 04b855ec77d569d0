// The quality of a point map, looked at by all processors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ndt/map_quality.hpp"

namespace landfix::tools {

struct QualitySettings {
  double radius_m = 1.0;
  std::size_t sample = 0;  ///< points to look at, spread evenly over the cloud; 0: all
  std::uint64_t seed = 1;  ///< of the sample
  bool keep_points = false;
};

/// A point that was looked at; NaN where it was skipped.
struct JudgedPoint {
  float x = 0.0F;  ///< [m]
  float y = 0.0F;
  float z = 0.0F;
  float entropy = std::numeric_limits<float>::quiet_NaN();
  float plane_variance_m = std::numeric_limits<float>::quiet_NaN();
};

/// A cloud, or what is needed of one that may be larger than the memory.
struct QualityCloud {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<std::uint32_t> chosen;  ///< of them, the points to look at
  std::uint64_t cloud_points = 0;     ///< of all of it
};

/// All of the clouds' points, or with a sample those and the points around them. Empty where the clouds are.
[[nodiscard]] QualityCloud load_quality_cloud(const std::vector<std::filesystem::path>& clouds,
                                              const QualitySettings& settings);

struct QualityResult {
  ndt::MapQuality quality;
  std::vector<JudgedPoint> points;  ///< in the cloud's order, if they are kept
};

/// The same for the same cloud and settings, on however many processors. `progress`: the share that is done.
[[nodiscard]] QualityResult judge_map(const ndt::NeighbourTree& tree, std::span<const std::uint32_t> chosen,
                                      const QualitySettings& settings,
                                      const std::function<void(double)>& progress);

}  // namespace landfix::tools
