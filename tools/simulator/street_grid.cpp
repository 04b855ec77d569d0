#include "tools/simulator/street_grid.hpp"

#include <algorithm>
#include <cmath>

namespace landfix::tools::simulator {

StreetGrid::StreetGrid(const City& city, const RoadProfile& road)
    : south_west_m(city.west_m, city.south_m),
      columns(static_cast<std::size_t>(city.columns)),
      rows(static_cast<std::size_t>(city.rows)),
      half_cell_m(0.5 * city.side_m / static_cast<double>(city.columns),
                  0.5 * city.side_m / static_cast<double>(city.rows)),
      half_block_m(half_cell_m.array() - road.half_width_m()),
      half_width_m(road.half_width_m()),
      corner_radius_m(road.pavement_width_m + kCornerBeyondPavement_m) {}

Eigen::Vector2d StreetGrid::middle_m(std::size_t block) const noexcept {
  const std::size_t row = block / columns;
  const Eigen::Vector2d cell(static_cast<double>(block % columns), static_cast<double>(row));
  return south_west_m + ((2.0 * cell.array() + 1.0) * half_cell_m.array()).matrix();
}

double StreetGrid::distance_to_street_m(const Eigen::Vector2d& xy_m) const noexcept {
  const Eigen::Array2d cell = (xy_m - south_west_m).array() / (2.0 * half_cell_m.array());
  const auto column = static_cast<std::size_t>(std::clamp(cell.x(), 0.0, static_cast<double>(columns - 1)));
  const auto row = static_cast<std::size_t>(std::clamp(cell.y(), 0.0, static_cast<double>(rows - 1)));
  // Signed distance to a rectangle with rounded corners, negative inside.
  const Eigen::Array2d beyond_m =
      (xy_m - middle_m(row * columns + column)).array().abs() - half_block_m.array() + corner_radius_m;
  const double to_kerb_m =
      beyond_m.max(0.0).matrix().norm() + std::min(0.0, beyond_m.maxCoeff()) - corner_radius_m;
  return std::max(0.0, half_width_m - to_kerb_m);
}

}  // namespace landfix::tools::simulator
