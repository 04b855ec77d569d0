// The ground of a city as triangles: rings around each block, from its lawn over kerb and carriageway to the
// middle of the streets, and a grid inside the innermost.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "tools/simulator/ground.hpp"

namespace landfix::tools::simulator {
namespace {

// The kerb's face: two rings almost above each other, on either side of the kerb's line.
constexpr double kAboveKerb_m = -0.008;
constexpr double kBelowKerb_m = 0.002;

/// Rings by their distance from the kerb, positive outwards; the last one is the edge of the cell instead.
struct Rings {
  std::vector<double> outwards_m;
  std::vector<Surface> surfaces;  ///< between them

  void to(double end_m, double step_m, Surface surface) {
    const double start_m = outwards_m.back();
    const int steps = std::max(1, static_cast<int>(std::ceil((end_m - start_m) / step_m)));
    for (int i = 1; i <= steps; ++i) {
      outwards_m.push_back(start_m + (end_m - start_m) * i / steps);
      surfaces.push_back(surface);
    }
  }
};

/// In as many steps for every ring, so that rings join to sheets.
void add_edge(std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& end_m, double length_m) {
  const int steps = std::max(1, static_cast<int>(std::ceil(length_m / 2.0)));
  const Eigen::Vector2d start_m = ring.back();
  for (int i = 1; i <= steps; ++i) ring.emplace_back(start_m + (end_m - start_m) * i / steps);
}

/// From the block's middle: for each quarter an arc about the middle of the corner's rounding, and the edge
/// to the next one.
std::vector<Eigen::Vector2d> ring_m(const StreetGrid& streets, double outwards_m, bool last) {
  constexpr int kArcSteps = 6;
  const Eigen::Vector2d corner_m = streets.half_block_m.array() - streets.corner_radius_m;
  const auto arc_m = [&](int quarter, int step) -> Eigen::Vector2d {
    const double angle_rad = 0.5 * std::numbers::pi * (quarter + static_cast<double>(step) / kArcSteps);
    const Eigen::Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
    const double stretch = last ? 1.0 / direction.cwiseAbs().maxCoeff() : 1.0;
    const Eigen::Vector2d middle_m(quarter % 4 == 0 || quarter % 4 == 3 ? corner_m.x() : -corner_m.x(),
                                   quarter % 4 < 2 ? corner_m.y() : -corner_m.y());
    return middle_m + stretch * (streets.corner_radius_m + outwards_m) * direction;
  };
  std::vector<Eigen::Vector2d> ring{arc_m(0, 0)};
  for (int quarter = 0; quarter < 4; ++quarter) {
    for (int step = 1; step <= kArcSteps; ++step) ring.push_back(arc_m(quarter, step));
    add_edge(ring, arc_m((quarter + 1) % 4, 0), 2.0 * (quarter % 2 == 0 ? corner_m.x() : corner_m.y()));
  }
  return ring;
}

}  // namespace

void Ground::add_streets(Mesh& mesh) const {
  constexpr double kLawnStep_m = 3.0;
  const StreetGrid& streets = *streets_;
  const double lawn_m = -streets.corner_radius_m;  // where the rounding has shrunk to a corner
  Rings rings{.outwards_m = {lawn_m}, .surfaces = {}};
  rings.to(-road_.pavement_width_m, 2.0, Surface::grass);
  rings.to(kAboveKerb_m, 1.5, Surface::concrete);
  rings.to(kBelowKerb_m, 1.0, Surface::concrete);
  rings.to(streets.half_width_m, 1.0, Surface::asphalt);
  // The edge of the cell: on the last ring along the edges of the block, beyond it in a crossing.
  rings.outwards_m.push_back(streets.half_width_m);
  rings.surfaces.push_back(Surface::asphalt);
  const Eigen::Vector2d half_lawn_m = streets.half_block_m.array() + lawn_m;
  const int lawn_columns = static_cast<int>(std::ceil(2.0 * half_lawn_m.x() / kLawnStep_m));
  const int lawn_rows = static_cast<int>(std::ceil(2.0 * half_lawn_m.y() / kLawnStep_m));

  for (std::size_t block = 0; block < streets.blocks(); ++block) {
    const auto on_ground = [&](const Eigen::Vector2d& from_middle_m) -> Eigen::Vector3d {
      const Eigen::Vector2d xy_m = streets.middle_m(block) + from_middle_m;
      return {xy_m.x(), xy_m.y(), height_m(xy_m)};
    };
    std::vector<std::vector<Eigen::Vector3d>> rows;
    for (std::size_t i = 0; i < rings.outwards_m.size(); ++i) {
      std::vector<Eigen::Vector3d>& row = rows.emplace_back();
      for (const Eigen::Vector2d& point_m :
           ring_m(streets, rings.outwards_m[i], i + 1 == rings.outwards_m.size())) {
        row.push_back(on_ground(point_m));
      }
    }
    // A sheet's surfaces go with its columns: each ring is a sheet of its own.
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
      add_sheet(mesh, std::span(rows).subspan(i, 2), std::vector(rows[i].size() - 1, rings.surfaces[i]));
    }
    std::vector<std::vector<Eigen::Vector3d>> lawn;
    for (int row = 0; row <= lawn_rows; ++row) {
      std::vector<Eigen::Vector3d>& points_m = lawn.emplace_back();
      for (int column = 0; column <= lawn_columns; ++column) {
        points_m.push_back(on_ground({half_lawn_m.x() * (2.0 * column / lawn_columns - 1.0),
                                      half_lawn_m.y() * (2.0 * row / lawn_rows - 1.0)}));
      }
    }
    add_sheet(mesh, lawn, std::vector(static_cast<std::size_t>(lawn_columns), Surface::grass));
  }
}

}  // namespace landfix::tools::simulator
