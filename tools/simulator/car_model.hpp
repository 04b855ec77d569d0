// Cars as others see them: bodies with bonnet, screens and roof, on wheels.
#pragma once

#include <array>
#include <cstddef>

#include "tools/simulator/mesh.hpp"

namespace landfix::tools::simulator {

inline constexpr std::size_t kCarModels = 3;

/// A hatchback, an estate, a van. Frame `vehicle`: the origin on the ground between the rear wheels.
[[nodiscard]] const std::array<Mesh, kCarModels>& car_models();

/// From bumper to bumper along x, for the longest model.
inline constexpr double kCarRear_m = -1.1;
inline constexpr double kCarFront_m = 4.2;

/// `part`, placed, joins `mesh`.
void add_mesh(Mesh& mesh, const Place& place, const Mesh& part);

}  // namespace landfix::tools::simulator
