#include "tools/map_raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "tools/class_grid.hpp"

namespace landfix::tools {
namespace {

constexpr double kFinestCell_m = 0.25;
constexpr std::size_t kMostCells = 1'000'000;
constexpr std::size_t kMostBytes = 1'500'000;
/// Differences of height within a cell at which the next shade begins.
constexpr std::array<float, kShades - 1> kShadeFrom_m{0.25F, 1.2F, 3.0F};

struct HeightRange {
  float low_m = std::numeric_limits<float>::infinity();
  float high_m = -std::numeric_limits<float>::infinity();
};

ClassGrid shade(std::span<const Eigen::Vector3f> points_m, const Eigen::AlignedBox2d& area_m, double cell_m) {
  ClassGrid grid{.columns = static_cast<std::size_t>(std::ceil(area_m.sizes().x() / cell_m)) + 1,
                 .rows = static_cast<std::size_t>(std::ceil(area_m.sizes().y() / cell_m)) + 1,
                 .classes = {}};
  std::vector<HeightRange> heights(grid.columns * grid.rows);
  const Eigen::Vector2d corner_m(area_m.min().x(), area_m.max().y());
  for (const Eigen::Vector3f& point_m : points_m) {
    const Eigen::Vector2d xy_m = point_m.head<2>().cast<double>();
    if (!point_m.allFinite() || !area_m.contains(xy_m)) continue;
    const auto column = static_cast<std::size_t>((xy_m.x() - corner_m.x()) / cell_m);
    const auto row = static_cast<std::size_t>((corner_m.y() - xy_m.y()) / cell_m);
    HeightRange& height = heights[row * grid.columns + column];
    height.low_m = std::min(height.low_m, point_m.z());
    height.high_m = std::max(height.high_m, point_m.z());
  }
  for (const HeightRange& height : heights) {
    const float range_m = height.high_m - height.low_m;
    const auto shade =
        std::upper_bound(kShadeFrom_m.begin(), kShadeFrom_m.end(), range_m) - kShadeFrom_m.begin();
    grid.classes.push_back(range_m < 0.0F ? ClassGrid::kEmpty : static_cast<std::uint8_t>(shade));
  }
  return grid;
}

/// Of the filled cells, nearly all have a filled neighbour to the right.
bool is_dense(const ClassGrid& grid) {
  constexpr double kShare = 0.85;
  std::size_t filled = 0;
  std::size_t continued = 0;
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column + 1 < grid.columns; ++column) {
      if (grid.at(column, row) == ClassGrid::kEmpty) continue;
      ++filled;
      if (grid.at(column + 1, row) != ClassGrid::kEmpty) ++continued;
    }
  }
  return static_cast<double>(continued) >= kShare * static_cast<double>(filled);
}

}  // namespace

MapRaster rasterise(std::span<const Eigen::Vector3f> points_m, const Eigen::AlignedBox2d& area_m) {
  constexpr double kCoarsestCell_m = 2.0;
  double cell_m = kFinestCell_m;
  const auto cells = [&area_m](double edge_m) {
    return (area_m.sizes().x() / edge_m + 2.0) * (area_m.sizes().y() / edge_m + 2.0);
  };
  while (cells(cell_m) > static_cast<double>(kMostCells)) cell_m *= 2.0;
  for (;; cell_m *= 2.0) {
    const ClassGrid grid = shade(points_m, area_m, cell_m);
    if (cell_m < kCoarsestCell_m && !is_dense(grid)) continue;
    MapRaster raster{.cell_m = cell_m, .paths = class_paths(grid, kShades)};
    std::size_t bytes = 0;
    for (const std::string& path : raster.paths) bytes += path.size();
    if (bytes <= kMostBytes) return raster;
  }
}

}  // namespace landfix::tools
