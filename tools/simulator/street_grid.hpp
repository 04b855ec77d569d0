// The streets of a city: a grid, with a block of houses in each of its cells.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "tools/simulator/route.hpp"

namespace landfix::tools::simulator {

/// Frame `map`, streets along its axes. A cell reaches from the middle of one street to the middle of the
/// next; its block is a rectangle with rounded corners, its edge the kerb.
struct StreetGrid {
  StreetGrid(const City& city, const RoadProfile& road);

  [[nodiscard]] std::size_t blocks() const noexcept { return columns * rows; }
  [[nodiscard]] Eigen::Vector2d middle_m(std::size_t block) const noexcept;
  /// From the middle of the nearest street; 0 all over a crossing's inside.
  [[nodiscard]] double distance_to_street_m(const Eigen::Vector2d& xy_m) const noexcept;

  Eigen::Vector2d south_west_m;
  std::size_t columns;
  std::size_t rows;
  Eigen::Vector2d half_cell_m;
  Eigen::Vector2d half_block_m;
  double half_width_m;  ///< of a street, between kerbs
  double corner_radius_m;
};

}  // namespace landfix::tools::simulator
