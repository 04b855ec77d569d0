// A road tunnel, the same all along its axis, so that little tells where in it one is.
#pragma once

#include "tools/simulator/ground.hpp"
#include "tools/simulator/mesh.hpp"
#include "tools/simulator/route.hpp"

namespace landfix::tools::simulator {

/// Emergency niches, where there are any: their middles are at whole multiples of the spacing.
inline constexpr double kNicheWidth_m = 2.0;
inline constexpr double kNicheDepth_m = 0.8;

/// Walls and vault over the whole of `ground`'s road.
void add_tunnel(Mesh& mesh, const Ground& ground, const Tunnel& tunnel);

}  // namespace landfix::tools::simulator
