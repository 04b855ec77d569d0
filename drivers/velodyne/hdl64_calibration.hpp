// What one HDL-64E says of its 64 lasers: the two-point calibration of the factory (HDL-64E S2 and S2.1
// User's Manual, firmware 4.07, db.xml and appendix F).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace landfix::drivers::velodyne {

/// Lasers 0 to 31 are the upper block, 32 to 63 the lower one.
inline constexpr std::size_t kHdl64Lasers = 64;

struct Hdl64Laser {
  bool enabled = true;
  double rotation_deg = 0.0;         ///< to be subtracted from the azimuth
  double elevation_deg = 0.0;        ///< up is positive
  double range_m = 0.0;              ///< to be added to ranges, as measured at 25.04 m
  double range_x_m = 0.0;            ///< the same, as measured at 2.40 m to the side
  double range_y_m = 0.0;            ///< the same, as measured at 1.93 m ahead
  double vertical_offset_m = 0.0;    ///< height of the beam at the axis
  double horizontal_offset_m = 0.0;  ///< of the beam from the axis, to the left where positive
  double focal_distance_m = 0.0;     ///< where returns are brightest
  double focal_slope = 0.0;          ///< how much less bright they are elsewhere
  std::uint8_t min_intensity = 0;    ///< bounds of the corrected intensity
  std::uint8_t max_intensity = 255;

  bool operator==(const Hdl64Laser&) const = default;
};

struct Hdl64Calibration {
  std::array<Hdl64Laser, kHdl64Lasers> lasers{};
  /// The sensor sends intensities that are corrected already (power level 0xA8).
  bool intensity_is_corrected = false;

  bool operator==(const Hdl64Calibration&) const = default;
};

/// Whether the numbers can be those of a laser; damaged files and streams say anything.
[[nodiscard]] inline bool is_plausible(const Hdl64Laser& laser) noexcept {
  // Written so that what is not a number fails.
  const auto within = [](double value, double bound) { return std::abs(value) <= bound; };
  return within(laser.rotation_deg, 90.0) && within(laser.elevation_deg, 90.0) &&
         within(laser.range_m, 10.0) && within(laser.range_x_m, 10.0) && within(laser.range_y_m, 10.0) &&
         within(laser.vertical_offset_m, 2.0) && within(laser.horizontal_offset_m, 2.0) &&
         within(laser.focal_distance_m, 1000.0) && within(laser.focal_slope, 1000.0) &&
         laser.min_intensity <= laser.max_intensity;
}

/// A calibration without two-point values holds zeros for them: the far one does for all distances then.
inline void complete_two_point(Hdl64Laser& laser) noexcept {
  if (laser.range_x_m != 0.0 || laser.range_y_m != 0.0) return;
  laser.range_x_m = laser.range_m;
  laser.range_y_m = laser.range_m;
}

}  // namespace landfix::drivers::velodyne
