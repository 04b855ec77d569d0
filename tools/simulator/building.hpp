// Houses whose walls have depth: windows and doors set back, ledges, balconies.
#pragma once

#include "tools/simulator/mesh.hpp"
#include "tools/simulator/random.hpp"

namespace landfix::tools::simulator {

struct BuildingSize {
  double width_m = 0.0;  ///< along x, the street
  double depth_m = 0.0;  ///< along y, away from it
  double height_m = 0.0;
};

/// `place`: the corner of the footprint that is the origin of x along the street front and y into the house,
/// z at the lowest ground of the footprint. `plinth_m`: how much higher the highest ground is.
void add_building(Mesh& mesh, const Place& place, const BuildingSize& size, double plinth_m, Random& random);

}  // namespace landfix::tools::simulator
