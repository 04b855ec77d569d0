#include "tools/map_raster.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

#include <fmt/format.h>

namespace landfix::tools {
namespace {

constexpr double kFinestCell_m = 0.25;
constexpr std::size_t kMostCells = 1'000'000;
constexpr std::size_t kMostBytes = 1'500'000;
constexpr std::uint8_t kEmpty = kShades;
/// Differences of height within a cell at which the next shade begins.
constexpr std::array<float, kShades - 1> kShadeFrom_m{0.25F, 1.2F, 3.0F};

struct HeightRange {
  float low_m = std::numeric_limits<float>::infinity();
  float high_m = -std::numeric_limits<float>::infinity();
};

/// The shade of each cell, rows from the top.
struct ShadeGrid {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<std::uint8_t> shades;

  [[nodiscard]] std::uint8_t at(std::size_t column, std::size_t row) const {
    return shades[row * columns + column];
  }
};

ShadeGrid shade(std::span<const Eigen::Vector3f> points_m, const Eigen::AlignedBox2d& area_m, double cell_m) {
  ShadeGrid grid{.columns = static_cast<std::size_t>(std::ceil(area_m.sizes().x() / cell_m)) + 1,
                 .rows = static_cast<std::size_t>(std::ceil(area_m.sizes().y() / cell_m)) + 1,
                 .shades = {}};
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
    grid.shades.push_back(range_m < 0.0F ? kEmpty : static_cast<std::uint8_t>(shade));
  }
  return grid;
}

/// Of the filled cells, nearly all have a filled neighbour to the right.
bool is_dense(const ShadeGrid& grid) {
  constexpr double kShare = 0.85;
  std::size_t filled = 0;
  std::size_t continued = 0;
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column + 1 < grid.columns; ++column) {
      if (grid.at(column, row) == kEmpty) continue;
      ++filled;
      if (grid.at(column + 1, row) != kEmpty) ++continued;
    }
  }
  return static_cast<double>(continued) >= kShare * static_cast<double>(filled);
}

/// Runs of one shade in a row are one rectangle.
std::array<std::string, kShades> draw(const ShadeGrid& grid) {
  std::array<std::string, kShades> paths;
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns;) {
      const std::uint8_t shade = grid.at(column, row);
      std::size_t end = column + 1;
      while (end < grid.columns && grid.at(end, row) == shade) ++end;
      if (shade != kEmpty) {
        paths[shade] += fmt::format("M{} {}h{}v1h-{}z", column, row, end - column, end - column);
      }
      column = end;
    }
  }
  return paths;
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
    const ShadeGrid grid = shade(points_m, area_m, cell_m);
    if (cell_m < kCoarsestCell_m && !is_dense(grid)) continue;
    MapRaster raster{.cell_m = cell_m, .paths = draw(grid)};
    std::size_t bytes = 0;
    for (const std::string& path : raster.paths) bytes += path.size();
    if (bytes <= kMostBytes) return raster;
  }
}

}  // namespace landfix::tools
