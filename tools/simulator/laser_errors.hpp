// What is wrong with one unit of a sensor: its lasers point a little higher or lower than its tables or its
// own calibration say, and measure a little too long or too short. Its decoder cannot know.
#pragma once

#include <array>
#include <cstdint>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator {

struct LaserError {
  double elevation_deg = 0.0;  ///< of where it points, above where it should
  double range_m = 0.0;        ///< of what it measures, too long
};

using LaserErrors = std::array<LaserError, kMostLasers>;

/// Those of one unit of many, by number, of the sizes that the sensor's traits say; unit 0 has none.
[[nodiscard]] LaserErrors laser_errors(const LidarTraits& lidar, std::uint64_t unit) noexcept;

}  // namespace landfix::tools::simulator
