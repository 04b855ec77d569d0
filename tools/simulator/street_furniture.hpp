// Lamps, traffic signs, fences and garden walls.
#pragma once

#include "tools/simulator/mesh.hpp"
#include "tools/simulator/random.hpp"

namespace landfix::tools::simulator {

/// A street lamp at the origin of `place`, its arm along y.
void add_lamp(Mesh& mesh, const Place& place, Random& random);
/// A traffic sign that faces those who come along x.
void add_sign(Mesh& mesh, const Place& place, Random& random);
/// Along x from 0 to `length_m`.
void add_fence(Mesh& mesh, const Place& place, double length_m);
void add_garden_wall(Mesh& mesh, const Place& place, double length_m, double height_m);

}  // namespace landfix::tools::simulator
