// What a user may choose about decoding; the defaults are what to drive with.
#pragma once

#include <limits>
#include <optional>

namespace landfix::drivers {

struct DecoderOptions {
  double cut_deg = 0.0;  ///< azimuth of the cut between sweeps, clockwise from the front; none for Ouster,
                         ///< whose frames are the sensor's own
  double min_range_m = 0.0;
  double max_range_m = std::numeric_limits<double>::infinity();

  /// RS-LiDAR-32: 0.005, or 0.01 for the firmware of 2018. Nothing: as the firmware's version says, which is
  /// not certain for every unit of 2018.
  std::optional<double> range_unit_m{};

  // To compare with clouds that leave them out.
  bool firing_time_azimuth =
      true;                      ///< turn each beam on by the time between its firing and the block's azimuth
  bool vertical_offsets = true;  ///< Velodyne: heights of the beams' origins
  bool optical_centre = true;    ///< Hesai, RoboSense: the beams start beside the axis of rotation
  bool two_point_correction = true;  ///< HDL-64E: ranges nearer than 25 m are corrected by their own values

  /// HDL-64E: a packet's time is that of its end, as the vendor's viewer reads it; otherwise that of its
  /// first firing, as the S3's manual does.
  bool hdl64_time_is_packet_end = true;
};

}  // namespace landfix::drivers
