// The vehicle's own odometry, from its bus: speed and yaw rate over the last seconds. What is wrong, silent
// or disagrees with the LiDAR is left out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "ndt/measured_motion.hpp"
#include "platform/can_frame.hpp"
#include "platform/odometry_channel.hpp"
#include "platform/vehicle_signal.hpp"

namespace landfix::platform {

struct OdometrySettings : VehicleSignals {
  double track_m = 0.0;  ///< between the rear wheels; above 0 they tell the yaw rate, if no signal does
};

struct OdometryCounters {
  std::uint64_t frames = 0;   ///< that hold a signal
  std::uint64_t samples = 0;  ///< of speed and yaw rate, that were taken
  std::uint64_t invalid = 0;  ///< values: not valid by their own word, beyond their limits, of unknown sign
  std::uint64_t jumps = 0;    ///< samples that no vehicle can follow, or out of order
  std::uint64_t silent = 0;   ///< sweeps during which a quantity was not told
  std::uint64_t times_left_out = 0;  ///< that one disagreed with the LiDAR
};

struct OdometryStatus {
  OdometryCounters counters;
  bool is_speed_believed = false;
  bool is_yaw_rate_believed = false;
};

/// Stamps are times of receipt, by one clock.
class Odometry {
 public:
  explicit Odometry(const OdometrySettings& settings) noexcept;

  void add(const CanFrame& frame, std::int64_t stamp_utc_ns) noexcept;

  /// The motion between two times. What is not believed or not known is taken from `otherwise`; nothing where
  /// that is all.
  [[nodiscard]] std::optional<ndt::MeasuredMotion> motion(std::int64_t from_utc_ns, std::int64_t to_utc_ns,
                                                          const ndt::Velocity& otherwise) const noexcept;

  /// After a sweep that was tracked: `matched`, how the vehicle moved from the sweep before.
  void compare(std::int64_t from_utc_ns, std::int64_t to_utc_ns, const ndt::Velocity& matched) noexcept;

  [[nodiscard]] OdometryCounters counters() const noexcept;
  [[nodiscard]] OdometryStatus status() const noexcept {
    return {counters(), speed_.is_believed(), yaw_rate_.is_believed()};
  }
  [[nodiscard]] const OdometryChannel& speed() const noexcept { return speed_; }
  [[nodiscard]] const OdometryChannel& yaw_rate() const noexcept { return yaw_rate_; }

 private:
  [[nodiscard]] std::optional<double> latest(VehicleRole role, std::int64_t stamp_utc_ns) const noexcept;
  [[nodiscard]] std::optional<double> direction(std::int64_t stamp_utc_ns) const noexcept;
  void add_wheels(std::int64_t stamp_utc_ns) noexcept;
  void add_speed(double speed_mps, std::int64_t stamp_utc_ns) noexcept;
  void count(bool taken) noexcept { ++(taken ? counters_.samples : counters_.jumps); }

  OdometrySettings settings_;
  std::array<LatestValue, kVehicleRoleNames.size()> latest_{};
  OdometryChannel speed_;
  OdometryChannel yaw_rate_;
  bool has_speed_;
  bool has_yaw_rate_;
  bool has_reverse_;
  OdometryCounters counters_;
};

}  // namespace landfix::platform
