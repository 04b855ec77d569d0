// The ten Ouster sensors of the simulator: one unit of each, with beam angles, a mode and a profile of its
// own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tools/simulator/ouster_packets.hpp"

namespace landfix::tools::simulator::ouster {

struct Beam {
  double altitude_deg = 0.0;
  double azimuth_deg = 0.0;  ///< clockwise from where the encoder points
};

struct Unit {
  std::string_view name;
  std::string_view prod_line;
  std::string_view firmware;
  std::size_t beams = 0;
  double half_field_deg = 0.0;    ///< of the vertical field of view
  double azimuth_step_deg = 0.0;  ///< the lasers stand in four columns, so far apart
  double beam_origin_mm = 0.0;    ///< from the axis to where the beams start
  double lift_mm = 0.0;           ///< from the base to the optical plane
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  double range_sigma_m = 0.0;
  std::size_t columns_per_turn = 1024;  ///< at 10 turns a second
  Profile profile = Profile::single;
  bool flat_metadata = false;    ///< as firmware up to 2.x gives it out
  bool sixty_four_rows = false;  ///< firmware up to 1.13 sends 64 rows, whatever the number of beams
  bool nmea_imu = false;         ///< the IMU packets of firmware 3.2
};

[[nodiscard]] std::span<const Unit> units() noexcept;

/// From the highest down.
[[nodiscard]] std::vector<Beam> beams_of(const Unit& unit);

}  // namespace landfix::tools::simulator::ouster
