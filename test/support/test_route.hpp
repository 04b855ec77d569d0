// Short routes for tests: every part of a street, a few seconds of simulation.
#pragma once

#include <string>

#include "tools/simulator/route.hpp"

namespace landfix::test {

inline const std::string kStreetRoute = R"(
seed = 5
heading_deg = 30.0
[road]
lanes = 2
parking_width_m = 2.2
[scenery]
parked_cars_per_100m = 16.0
moving_cars_per_100m = 3.0
[[segment]]
length_m = 12.0
speed_kmh = 20.0
[[segment]]
length_m = 16.0
turn_deg = 20.0
grade = 0.06
speed_kmh = 20.0
)";

/// Nothing but ground, houses and parked cars.
inline const std::string kBareRoute = R"(
seed = 6
[road]
lanes = 2
parking_width_m = 2.2
[scenery]
trees_per_100m = 0.0
boundaries_per_100m = 0.0
signs_per_100m = 0.0
poles_per_100m = 0.0
moving_cars_per_100m = 0.0
parked_cars_per_100m = 20.0
[[segment]]
length_m = 25.0
speed_kmh = 20.0
)";

inline tools::simulator::Route route_of(const std::string& toml) {
  return tools::simulator::parse_route(toml, "test.toml");
}

}  // namespace landfix::test
