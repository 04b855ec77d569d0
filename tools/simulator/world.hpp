// The world of a route: everything that stands beside the road, and the cars on it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/simulator/ground.hpp"
#include "tools/simulator/mesh.hpp"
#include "tools/simulator/route.hpp"

namespace landfix::tools::simulator {

/// Another car's way: where it is when the vehicle's drive begins, and how it goes on.
struct Traffic {
  double station_m = 0.0;        ///< at the start of the drive
  double offset_m = 0.0;         ///< of its lane
  double speed_mps = 0.0;        ///< of its own, constant; negative comes towards the vehicle
  double follows_vehicle = 0.0;  ///< how many metres it goes on for each metre that the vehicle drives
  std::size_t model = 0;         ///< of `car_models`
};

struct World {
  Mesh surveyed;  ///< what a surveyor would find another day: ground, buildings, vegetation, furniture
  Mesh parked;    ///< cars that stand here today
  std::vector<Traffic> traffic;
};

/// The same route, ground and seed give the same world.
[[nodiscard]] World build_world(const Route& route, const Ground& ground, std::uint64_t seed);

/// Where side streets join; they are part of the ground.
[[nodiscard]] std::vector<SideStreet> plan_side_streets(const Route& route, const Path& path,
                                                        std::uint64_t seed);

}  // namespace landfix::tools::simulator
