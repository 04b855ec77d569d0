// All that the CAN frames can say of a pose, in the units of the code.
#pragma once

#include <cstdint>
#include <limits>

#include "drivers/sweep.hpp"
#include "ndt/localizer.hpp"

namespace landfix::platform {

/// Numbers are NaN where they are not available. Position and attitude: map <- vehicle. Speeds and turn
/// rates: frame `vehicle`. Sigmas: one standard deviation in a level frame with the vehicle's heading.
struct PoseReport {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  static constexpr std::int64_t kNoTime = -1;

  std::int64_t stamp_utc_ns = kNoTime;  ///< the time that the pose holds for
  double x_m = kNone;
  double y_m = kNone;
  double z_m = kNone;
  double roll_rad = kNone;
  double pitch_rad = kNone;
  double yaw_rad = kNone;
  double speed_x_mps = kNone;
  double speed_y_mps = kNone;
  double speed_z_mps = kNone;
  double roll_rate_radps = kNone;
  double pitch_rate_radps = kNone;
  double yaw_rate_radps = kNone;
  double sigma_along_m = kNone;
  double sigma_cross_m = kNone;
  double sigma_up_m = kNone;
  double sigma_roll_rad = kNone;
  double sigma_pitch_rad = kNone;
  double sigma_yaw_rad = kNone;
  double score = kNone;       ///< nearest voxel likelihood as a share of the best there can be, 0 to 1
  double iterations = kNone;  ///< of the matcher
  double age_s = kNone;       ///< from the last sweep's last point to the sending
  double latitude_deg = kNone;
  double longitude_deg = kNone;

  // Codes: numbers that name something.
  std::uint16_t state = 0;          ///< ndt::State
  std::uint16_t time_source = 0;    ///< drivers::TimeSource
  std::uint16_t saturated = 0;      ///< 1: a value is beyond what its signal can hold
  std::uint16_t partial_sweep = 0;  ///< 1: the sweep was no whole turn
  std::uint16_t weak = 0;           ///< 1: the map does not hold every direction
  std::uint16_t weak_axes = 0;      ///< a bit for each ndt::Axis
  std::uint16_t map_hash = 0;
  std::uint16_t map_origin = 0;
  std::uint16_t map_projector = 0;
  std::uint16_t map_datum = 0;
  std::uint16_t utm_zone = 0;  ///< that the map's x and y come from; 0: none
  std::uint16_t frames_version = 0;
};

/// Of a fix that is sent when it is made. One that is not to be used has neither position nor velocity.
[[nodiscard]] PoseReport report_of(const ndt::Fix& fix, drivers::TimeSource time_source,
                                   bool is_whole_sweep) noexcept;

}  // namespace landfix::platform
