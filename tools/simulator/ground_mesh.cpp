// The ground as triangles: a sheet along the road, and a grid of the land that begins where the sheet ends.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/simulator/ground.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr double kRowSpacing_m = 0.5;
constexpr double kColumnSpacing_m = 0.5;
// The kerb's face: two vertices almost above each other.
constexpr double kKerbBatter_m = 0.01;

/// Places across one half of the road, from its middle outwards.
struct HalfSection {
  std::vector<double> away_m;
  std::vector<Surface> surfaces;  ///< between them

  void to(double end_m, double step_m, Surface surface) {
    const double start_m = away_m.back();
    const int steps = std::max(1, static_cast<int>(std::ceil((end_m - start_m) / step_m)));
    for (int i = 1; i <= steps; ++i) {
      away_m.push_back(start_m + (end_m - start_m) * i / steps);
      surfaces.push_back(surface);
    }
  }
};

}  // namespace

void Ground::add_road(Mesh& mesh) const {
  const double half_m = road_.half_width_m();
  HalfSection section{.away_m = {0.0}, .surfaces = {}};
  section.to(half_m, kColumnSpacing_m, Surface::asphalt);
  section.to(half_m + kKerbBatter_m, kColumnSpacing_m, Surface::concrete);
  section.to(half_m + road_.pavement_width_m, kColumnSpacing_m, Surface::concrete);
  if (land_profile_.reach_m > 0.0) section.to(corridor_half_width_m(), kColumnSpacing_m, Surface::grass);

  std::vector<double> offsets_m;
  offsets_m.reserve(2 * section.away_m.size());
  const std::vector<double> inwards_m(section.away_m.rbegin(), section.away_m.rend());
  for (const double away_m : inwards_m) offsets_m.push_back(road_.centre_offset_m() - away_m);
  for (std::size_t i = 1; i < section.away_m.size(); ++i) {
    offsets_m.push_back(road_.centre_offset_m() + section.away_m[i]);
  }
  std::vector<Surface> surfaces(section.surfaces.rbegin(), section.surfaces.rend());
  surfaces.insert(surfaces.end(), section.surfaces.begin(), section.surfaces.end());

  std::vector<std::vector<Eigen::Vector3d>> rows;
  for (double s = path_.first_station_m(); s <= path_.last_station_m(); s += kRowSpacing_m) {
    std::vector<Eigen::Vector3d>& row = rows.emplace_back();
    for (const double offset_m : offsets_m) row.push_back(point_m({s, offset_m}));
  }
  add_sheet(mesh, rows, surfaces);
}

void Ground::add_land(Mesh& mesh) const {
  const auto vertex = [this](std::size_t column, std::size_t row) {
    const Eigen::Vector2d xy_m = land_node_m(column, row);
    return Eigen::Vector3d(xy_m.x(), xy_m.y(),
                           static_cast<double>(land_.height_m[row * land_.columns + column]));
  };
  const auto distance_m = [this](std::size_t column, std::size_t row) {
    return static_cast<double>(land_.distance_m[row * land_.columns + column]);
  };
  for (std::size_t row = 0; row + 1 < land_.rows; ++row) {
    for (std::size_t column = 0; column + 1 < land_.columns; ++column) {
      const auto [nearest, farthest] =
          std::minmax({distance_m(column, row), distance_m(column + 1, row), distance_m(column, row + 1),
                       distance_m(column + 1, row + 1)});
      if (farthest < corridor_half_width_m() || !std::isfinite(farthest)) continue;
      add_quad(mesh, Place::Identity(),
               {vertex(column, row), vertex(column + 1, row), vertex(column + 1, row + 1),
                vertex(column, row + 1)},
               Surface::grass);
    }
  }
}

Mesh Ground::mesh() const {
  Mesh mesh;
  if (streets_) {
    add_streets(mesh);
    return mesh;
  }
  add_road(mesh);
  if (land_profile_.reach_m > 0.0) add_land(mesh);
  return mesh;
}

}  // namespace landfix::tools::simulator
