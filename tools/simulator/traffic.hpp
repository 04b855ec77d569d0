// Where the other cars are at an instant.
#pragma once

#include <span>
#include <vector>

#include "tools/simulator/ground.hpp"
#include "tools/simulator/scene.hpp"
#include "tools/simulator/vehicle_motion.hpp"
#include "tools/simulator/world.hpp"

namespace landfix::tools::simulator {

/// The cars within `reach_m` of the vehicle.
[[nodiscard]] std::vector<MovingCar> cars_near_vehicle(std::span<const Traffic> traffic, const Ground& ground,
                                                       const VehicleMotion& vehicle, double time_s,
                                                       double reach_m);

}  // namespace landfix::tools::simulator
