#include "tools/simulator/laser_errors.hpp"

#include "tools/simulator/random.hpp"

namespace landfix::tools::simulator {

LaserErrors laser_errors(const LidarTraits& lidar, std::uint64_t unit) noexcept {
  LaserErrors errors{};
  if (unit == 0) return errors;
  Random random(unit, RandomStream::unit);
  for (LaserError& error : errors) {
    error.elevation_deg = lidar.elevation_sigma_deg * random.normal();
    error.range_m = lidar.range_sigma_m * random.normal();
  }
  return errors;
}

}  // namespace landfix::tools::simulator
