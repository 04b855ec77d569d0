// One laser of a sensor as its table in config/sensors gives it: where it points and when it fires.
#pragma once

#include <cstdint>

namespace landfix::drivers {

struct Beam {
  std::uint16_t ring = 0;           ///< rank of the elevation, 0 is the lowest
  double elevation_deg = 0.0;       ///< up is positive
  double azimuth_offset_deg = 0.0;  ///< to be added to the azimuth, clockwise seen from above
  double vertical_offset_m = 0.0;   ///< height of the beam's origin above the optical origin
  double firing_time_us = 0.0;      ///< since the moment the block's azimuth was taken; may be negative
};

}  // namespace landfix::drivers
