#include "tools/simulator/mesh.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace landfix::tools::simulator {
namespace {

constexpr std::array kReflectivity{
    0.15,  // asphalt
    0.30,  // concrete
    0.40,  // grass
    0.55,  // plaster
    0.35,  // brick
    0.05,  // glass
    0.40,  // wood
    0.45,  // leaf
    0.30,  // metal
    0.35,  // paint
    2.20,  // sign
};
static_assert(kReflectivity.size() == static_cast<std::size_t>(Surface::sign) + 1);

std::uint32_t add_vertex(Mesh& mesh, const Eigen::Vector3d& position_m) {
  mesh.vertices_m.emplace_back(position_m.cast<float>());
  return static_cast<std::uint32_t>(mesh.vertices_m.size() - 1);
}

void join(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, Surface surface) {
  mesh.triangles.push_back({a, b, c});
  mesh.surfaces.push_back(surface);
}

}  // namespace

double reflectivity(Surface surface) noexcept { return kReflectivity[static_cast<std::size_t>(surface)]; }

Place make_place(const Eigen::Vector3d& position_m, double heading_rad) {
  Place place = Place::Identity();
  place.linear() = Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  place.translation() = position_m;
  return place;
}

void add_triangle(Mesh& mesh, const Place& place, const std::array<Eigen::Vector3d, 3>& corners,
                  Surface surface) {
  const std::uint32_t a = add_vertex(mesh, place * corners[0]);
  const std::uint32_t b = add_vertex(mesh, place * corners[1]);
  join(mesh, a, b, add_vertex(mesh, place * corners[2]), surface);
}

void add_quad(Mesh& mesh, const Place& place, const std::array<Eigen::Vector3d, 4>& corners,
              Surface surface) {
  const std::uint32_t a = add_vertex(mesh, place * corners[0]);
  const std::uint32_t b = add_vertex(mesh, place * corners[1]);
  const std::uint32_t c = add_vertex(mesh, place * corners[2]);
  join(mesh, a, b, c, surface);
  join(mesh, a, c, add_vertex(mesh, place * corners[3]), surface);
}

void add_box(Mesh& mesh, const Place& place, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
             Surface surface) {
  const auto corner = [&](int x, int y, int z) {
    return Eigen::Vector3d(x != 0 ? high.x() : low.x(), y != 0 ? high.y() : low.y(),
                           z != 0 ? high.z() : low.z());
  };
  add_quad(mesh, place, {corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1)}, surface);
  add_quad(mesh, place, {corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1)}, surface);
  add_quad(mesh, place, {corner(1, 1, 0), corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1)}, surface);
  add_quad(mesh, place, {corner(0, 1, 0), corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1)}, surface);
  add_quad(mesh, place, {corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)}, surface);
}

void add_tube(Mesh& mesh, const Place& place, double low_radius_m, double high_radius_m, double height_m,
              Surface surface) {
  constexpr int kSides = 8;
  const auto rim = [](double radius_m, double z_m, int side) {
    const double angle_rad = 2.0 * std::numbers::pi * side / kSides;
    return Eigen::Vector3d(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), z_m);
  };
  for (int side = 0; side < kSides; ++side) {
    add_quad(mesh, place,
             {rim(low_radius_m, 0.0, side), rim(low_radius_m, 0.0, side + 1),
              rim(high_radius_m, height_m, side + 1), rim(high_radius_m, height_m, side)},
             surface);
    add_triangle(mesh, place,
                 {rim(high_radius_m, height_m, side), rim(high_radius_m, height_m, side + 1),
                  Eigen::Vector3d(0.0, 0.0, height_m)},
                 surface);
  }
}

void add_sheet(Mesh& mesh, std::span<const std::vector<Eigen::Vector3d>> rows,
               std::span<const Surface> surfaces) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
  for (const std::vector<Eigen::Vector3d>& row : rows) {
    for (const Eigen::Vector3d& vertex : row) add_vertex(mesh, vertex);
  }
  const auto columns = static_cast<std::uint32_t>(surfaces.size());
  for (std::uint32_t row = 0; row + 1 < rows.size(); ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t a = first + row * (columns + 1) + column;
      const std::uint32_t b = a + columns + 1;
      join(mesh, a, b, b + 1, surfaces[column]);
      join(mesh, a, b + 1, a + 1, surfaces[column]);
    }
  }
}

}  // namespace landfix::tools::simulator
