#include "tools/simulator/street_furniture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace landfix::tools::simulator {
namespace {

constexpr double kSunk_m = 0.3;

Place sunk(const Place& place) { return place * make_place({0, 0, -kSunk_m}, 0.0); }

}  // namespace

void add_lamp(Mesh& mesh, const Place& place, Random& random) {
  const double height_m = random.uniform(5.5, 8.0);
  const double radius_m = random.uniform(0.07, 0.11);
  add_tube(mesh, sunk(place), radius_m, 0.6 * radius_m, height_m + kSunk_m, Surface::metal);
  add_box(mesh, place, {-0.04, 0.0, height_m - 0.08}, {0.04, 1.2, height_m}, Surface::metal);
  add_box(mesh, place, {-0.15, 0.9, height_m - 0.2}, {0.15, 1.6, height_m - 0.08}, Surface::metal);
}

void add_sign(Mesh& mesh, const Place& place, Random& random) {
  const double height_m = random.uniform(2.2, 2.8);
  add_tube(mesh, sunk(place), 0.035, 0.035, height_m + kSunk_m, Surface::metal);
  constexpr int kSides = 12;
  const double radius_m = random.uniform(0.3, 0.42);
  const auto rim = [&](int side) {
    const double angle_rad = 2.0 * std::numbers::pi * side / kSides;
    return Eigen::Vector3d(-0.05, radius_m * std::cos(angle_rad),
                           height_m - radius_m + radius_m * std::sin(angle_rad));
  };
  for (int side = 0; side < kSides; ++side) {
    add_triangle(mesh, place, {rim(side), rim(side + 1), Eigen::Vector3d(-0.05, 0.0, height_m - radius_m)},
                 Surface::sign);
  }
}

void add_fence(Mesh& mesh, const Place& place, double length_m) {
  constexpr double kHeight_m = 1.1;
  const int fields = std::max(1, static_cast<int>(length_m / 1.8));
  for (int post = 0; post <= fields; ++post) {
    const double x_m = length_m * post / fields;
    add_box(mesh, place, {x_m - 0.05, -0.05, -kSunk_m}, {x_m + 0.05, 0.05, kHeight_m}, Surface::wood);
  }
  for (const double low_m : {0.2, 0.5, 0.8}) {
    add_box(mesh, place, {0.0, -0.03, low_m}, {length_m, 0.0, low_m + 0.16}, Surface::wood);
  }
}

void add_garden_wall(Mesh& mesh, const Place& place, double length_m, double height_m) {
  add_box(mesh, place, {0.0, -0.12, -kSunk_m}, {length_m, 0.12, height_m}, Surface::brick);
  add_box(mesh, place, {0.0, -0.17, height_m}, {length_m, 0.17, height_m + 0.06}, Surface::concrete);
}

}  // namespace landfix::tools::simulator
