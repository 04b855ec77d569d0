// How fast the route is driven: as its segments allow, and no harder than passengers like.
#pragma once

#include <vector>

#include "tools/simulator/path.hpp"
#include "tools/simulator/route.hpp"

namespace landfix::tools::simulator {

/// Stations [m] every `period_s` from the start of the drive to its end. The vehicle stands for the first
/// second and the last, and its acceleration does not jump.
[[nodiscard]] std::vector<double> drive_stations(const Route& route, const Path& path, double period_s);

}  // namespace landfix::tools::simulator
