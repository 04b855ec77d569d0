#include "platform/gnss.hpp"

#include <Eigen/Geometry>

#include "ndt/pose.hpp"

namespace landfix::platform {

void Gnss::add(const CanFrame& frame, std::int64_t stamp_utc_ns) noexcept {
  bool any = false;
  for (const VehicleSignal& signal : settings_.all()) {
    if (!signal.is_in(frame)) continue;
    any = true;
    if (const auto value = value_of(signal, frame)) {
      latest_[static_cast<std::size_t>(signal.role)].set(*value, stamp_utc_ns, signal.timeout_ns);
    } else {
      ++counters_.invalid;
    }
  }
  counters_.frames += any ? 1 : 0;
}

std::optional<ndt::PoseGuess> Gnss::guess(std::int64_t now_utc_ns) noexcept {
  const auto latitude_rad = latest(VehicleRole::latitude, now_utc_ns);
  const auto longitude_rad = latest(VehicleRole::longitude, now_utc_ns);
  if (!projection_ || !latitude_rad || !longitude_rad) return std::nullopt;
  const auto altitude_m = latest(VehicleRole::altitude, now_utc_ns);
  const auto heading_rad = latest(VehicleRole::heading, now_utc_ns);
  const MapPlace antenna = to_map(*projection_, {.latitude_deg = *latitude_rad / ndt::kRadians_per_deg,
                                                 .longitude_deg = *longitude_rad / ndt::kRadians_per_deg,
                                                 .altitude_m = altitude_m.value_or(0.0)});
  if (!antenna.position_m.allFinite()) return std::nullopt;

  ndt::PoseGuess guess{.position_m = antenna.position_m.head<2>(), .within_m = settings_.accuracy_m};
  const Eigen::Vector2d lever_m = settings_.antenna_m.head<2>();
  if (altitude_m) guess.height_m = antenna.position_m.z() - settings_.antenna_m.z();
  if (heading_rad) {
    guess.yaw_rad = antenna.north_rad - *heading_rad;
    guess.position_m -= Eigen::Rotation2Dd(*guess.yaw_rad) * lever_m;
  } else {
    guess.within_m += lever_m.norm();
  }
  ++counters_.guesses;
  return guess;
}

}  // namespace landfix::platform
