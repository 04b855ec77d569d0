// The one point type that every decoder emits.
#pragma once

#include <cstdint>

namespace landfix::drivers {

/// One return of one laser. Frame `sensor`: x forward, y left, z up, origin at the vendor's optical origin.
struct Point {
  float x = 0.0F;          ///< [m]
  float y = 0.0F;          ///< [m]
  float z = 0.0F;          ///< [m]
  float intensity = 0.0F;  ///< [0..255] as the sensor reports it
  float time_s = 0.0F;     ///< firing time since the start of the sweep, >= 0
  std::uint16_t ring = 0;  ///< rank of the beam's elevation, 0 is the lowest
};
static_assert(sizeof(Point) == 24);

}  // namespace landfix::drivers
