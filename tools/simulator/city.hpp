// The blocks of a city: houses around a yard, with walls in the gaps; trees, lamps, signs and parked cars
// along the kerbs.
#pragma once

#include "tools/simulator/ground.hpp"
#include "tools/simulator/mesh.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/route.hpp"

namespace landfix::tools::simulator {

/// `ground` has streets. Of the scenery, boundaries and side streets say nothing here.
void add_city(Mesh& surveyed, Mesh& parked, const Ground& ground, const Scenery& scenery, Random& random);

}  // namespace landfix::tools::simulator
