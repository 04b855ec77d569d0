// Trees and hedges: leaves in disorder, so that returns scatter as they do in the field.
#pragma once

#include "tools/simulator/mesh.hpp"
#include "tools/simulator/random.hpp"

namespace landfix::tools::simulator {

/// A trunk at the origin of `place` and a crown of single leaves.
void add_tree(Mesh& mesh, const Place& place, Random& random);

/// A hedge along x from 0 to `length_m`, centred on y = 0.
void add_hedge(Mesh& mesh, const Place& place, double length_m, double height_m, Random& random);

}  // namespace landfix::tools::simulator
