// One laser of a sensor as its table in config/sensors gives it: where it points and when it fires.
#pragma once

#include <cstddef>
#include <cstdint>

namespace landfix::drivers {

struct Beam {
  std::uint16_t ring = 0;           ///< rank of the elevation, 0 is the lowest
  double elevation_deg = 0.0;       ///< up is positive
  double azimuth_offset_deg = 0.0;  ///< to be added to the azimuth, clockwise seen from above
  double vertical_offset_m = 0.0;   ///< height of the beam's origin above the optical origin
  double firing_time_us = 0.0;      ///< since the moment the block's azimuth was taken; may be negative
};

/// The ring of beam `i` of `count`: how many are lower. Those of equal elevation keep their order.
/// `elevation_deg` is a function of the beam.
template <class Elevation>
[[nodiscard]] constexpr std::uint16_t ring_of(std::size_t i, std::size_t count, Elevation elevation_deg) {
  std::uint16_t lower = 0;
  for (std::size_t other = 0; other < count; ++other) {
    const double above_deg = elevation_deg(other) - elevation_deg(i);
    if (above_deg < 0.0 || (above_deg == 0.0 && other < i)) ++lower;
  }
  return lower;
}

}  // namespace landfix::drivers
