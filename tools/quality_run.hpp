// The quality of a point map, looked at by all processors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

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

struct QualityResult {
  ndt::MapQuality quality;
  std::vector<JudgedPoint> points;  ///< in the cloud's order, if they are kept
};

/// The same for the same cloud and settings, on however many processors. `progress`: the share that is done.
[[nodiscard]] QualityResult judge_map(const ndt::NeighbourTree& tree, const QualitySettings& settings,
                                      const std::function<void(double)>& progress);

}  // namespace landfix::tools
