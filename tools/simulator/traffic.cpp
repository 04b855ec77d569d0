#include "tools/simulator/traffic.hpp"

#include <cmath>
#include <numbers>

namespace landfix::tools::simulator {

std::vector<MovingCar> cars_near_vehicle(std::span<const Traffic> traffic, const Ground& ground,
                                         const VehicleMotion& vehicle, double time_s, double reach_m) {
  constexpr double kRoadEnd_m = 10.0;  // where cars come into the world and leave it
  const double vehicle_station_m = vehicle.station_at(time_s);
  const double vehicle_speed_mps = vehicle.speed_at(time_s);
  std::vector<MovingCar> cars;
  for (const Traffic& one : traffic) {
    const double station_m = one.station_m + one.speed_mps * time_s + one.follows_vehicle * vehicle_station_m;
    const double speed_mps = one.speed_mps + one.follows_vehicle * vehicle_speed_mps;
    if (std::abs(station_m - vehicle_station_m) > reach_m ||
        station_m < ground.path().first_station_m() + kRoadEnd_m ||
        station_m > ground.path().last_station_m() - kRoadEnd_m) {
      continue;
    }
    const Place place =
        ground.vehicle_place({station_m, one.offset_m}, one.speed_mps < 0.0 ? std::numbers::pi : 0.0);
    cars.push_back(
        {.place = place, .velocity_mps = std::abs(speed_mps) * place.linear().col(0), .model = one.model});
  }
  return cars;
}

}  // namespace landfix::tools::simulator
