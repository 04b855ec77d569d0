// Position and heading from a satellite receiver on the vehicle's bus: where the vehicle is to be looked for.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include <Eigen/Core>

#include "ndt/pose_guess.hpp"
#include "platform/can_frame.hpp"
#include "platform/map_projection.hpp"
#include "platform/vehicle_signal.hpp"

namespace landfix::platform {

struct GnssSettings : VehicleSignals {
  Eigen::Vector3d antenna_m = Eigen::Vector3d::Zero();  ///< in the frame vehicle
  double accuracy_m = 3.0;                              ///< the antenna is no farther from what it says
};

struct GnssCounters {
  std::uint64_t frames = 0;   ///< that hold a signal
  std::uint64_t invalid = 0;  ///< values: not valid by their own word, or beyond their limits
  std::uint64_t guesses = 0;  ///< that were asked for and could be given
};

/// Stamps are times of receipt, by one clock.
class Gnss {
 public:
  /// `projection`: of the map; without one nothing can be told.
  Gnss(GnssSettings settings, std::optional<MapProjection> projection) noexcept
      : settings_(std::move(settings)), projection_(std::move(projection)) {}

  void add(const CanFrame& frame, std::int64_t stamp_utc_ns) noexcept;

  /// Nothing where latitude or longitude are not known, or not any more.
  [[nodiscard]] std::optional<ndt::PoseGuess> guess(std::int64_t now_utc_ns) noexcept;

  [[nodiscard]] const GnssCounters& counters() const noexcept { return counters_; }

 private:
  [[nodiscard]] std::optional<double> latest(VehicleRole role, std::int64_t now_utc_ns) const noexcept {
    return latest_[static_cast<std::size_t>(role)].at(now_utc_ns);
  }

  GnssSettings settings_;
  std::optional<MapProjection> projection_;
  std::array<LatestValue, kVehicleRoleNames.size()> latest_{};
  GnssCounters counters_;
};

}  // namespace landfix::platform
