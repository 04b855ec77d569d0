// Triangle meshes and the few solids that the simulated world is made of.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace landfix::tools::simulator {

enum class Surface : std::uint8_t {
  asphalt,
  concrete,
  grass,
  plaster,
  brick,
  glass,
  wood,
  leaf,
  metal,
  paint,
  sign
};

/// Diffuse reflectivity at 905 nm, 1 is white paper; a retro-reflector sends back more than that.
[[nodiscard]] double reflectivity(Surface surface) noexcept;

/// Frame `map`, unless it is a part to be placed.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Surface> surfaces;  ///< one a triangle
};

/// Where a part stands: its own frame is x along the road, y left, z up.
using Place = Eigen::Isometry3d;
[[nodiscard]] Place make_place(const Eigen::Vector3d& position_m, double heading_rad);

void add_triangle(Mesh& mesh, const Place& place, const std::array<Eigen::Vector3d, 3>& corners,
                  Surface surface);
/// Corners in order around the face.
void add_quad(Mesh& mesh, const Place& place, const std::array<Eigen::Vector3d, 4>& corners, Surface surface);
/// A box without a floor.
void add_box(Mesh& mesh, const Place& place, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
             Surface surface);
/// A tube along z from 0 to `height_m`, round enough for a pole or a trunk, open below.
void add_tube(Mesh& mesh, const Place& place, double low_radius_m, double high_radius_m, double height_m,
              Surface surface);
/// Rows of equally many vertices (frame `map`), joined to a sheet. `surfaces`: one a column, one fewer than
/// the vertices of a row.
void add_sheet(Mesh& mesh, std::span<const std::vector<Eigen::Vector3d>> rows,
               std::span<const Surface> surfaces);

}  // namespace landfix::tools::simulator
