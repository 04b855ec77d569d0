#include "tools/simulator/vegetation.hpp"

#include <cmath>

namespace landfix::tools::simulator {
namespace {

Eigen::Vector3d random_direction(Random& random) {
  for (;;) {
    const Eigen::Vector3d v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (v.squaredNorm() > 0.01 && v.squaredNorm() <= 1.0) return v.normalized();
  }
}

/// A leaf stands for a twig's worth of them: a triangle of about `size_m` that faces anywhere.
void add_leaf(Mesh& mesh, const Place& place, const Eigen::Vector3d& centre_m, double size_m,
              Random& random) {
  const Eigen::Vector3d along = random_direction(random);
  const Eigen::Vector3d across = along.cross(random_direction(random)).normalized();
  add_triangle(mesh, place,
               {centre_m - 0.5 * size_m * along, centre_m + 0.5 * size_m * along, centre_m + size_m * across},
               Surface::leaf);
}

}  // namespace

void add_tree(Mesh& mesh, const Place& place, Random& random) {
  const double trunk_m = random.uniform(1.9, 3.2);
  const double radius_m = random.uniform(0.10, 0.24);
  const Eigen::Vector3d crown_m{random.uniform(1.3, 2.6), random.uniform(1.3, 2.6), random.uniform(1.5, 3.0)};
  const double lean_x_rad = random.uniform(-0.05, 0.05);
  const double lean_y_rad = random.uniform(-0.05, 0.05);
  const Place lean = place * Eigen::AngleAxisd(lean_x_rad, Eigen::Vector3d::UnitX()) *
                     Eigen::AngleAxisd(lean_y_rad, Eigen::Vector3d::UnitY());
  add_tube(mesh, lean * make_place({0, 0, -0.3}, 0.0), radius_m, 0.6 * radius_m, trunk_m + crown_m.z(),
           Surface::wood);

  // Boughs: the crown is several overlapping tufts, not one ellipsoid.
  const Eigen::Vector3d middle_m(0.0, 0.0, trunk_m + 0.8 * crown_m.z());
  constexpr int kTufts = 7;
  constexpr int kLeavesPerTuft = 110;
  for (int tuft = 0; tuft < kTufts; ++tuft) {
    const Eigen::Vector3d tuft_m =
        middle_m + (0.55 * crown_m.array() * random_direction(random).array()).matrix();
    const double spread_m = random.uniform(0.4, 0.6) * crown_m.minCoeff();
    for (int leaf = 0; leaf < kLeavesPerTuft; ++leaf) {
      const double from_middle_m = spread_m * std::cbrt(random.uniform(0.05, 1.0));
      const Eigen::Vector3d centre_m = tuft_m + from_middle_m * random_direction(random);
      add_leaf(mesh, lean, centre_m, random.uniform(0.18, 0.34), random);
    }
  }
}

void add_hedge(Mesh& mesh, const Place& place, double length_m, double height_m, Random& random) {
  constexpr double kHalfDepth_m = 0.35;
  constexpr double kLeavesPerMetre = 70.0;
  // A dense inside, so that nothing is seen through it, below a skin of leaves.
  add_box(mesh, place, {0.1, 0.15 - kHalfDepth_m, -0.3},
          {length_m - 0.1, kHalfDepth_m - 0.15, height_m - 0.15}, Surface::leaf);
  const int leaves = static_cast<int>(kLeavesPerMetre * length_m * height_m);
  for (int leaf = 0; leaf < leaves; ++leaf) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    const Eigen::Vector3d centre_m{random.uniform(0.0, length_m), side * random.uniform(0.18, kHalfDepth_m),
                                   random.uniform(0.0, height_m)};
    add_leaf(mesh, place, centre_m, random.uniform(0.12, 0.2), random);
  }
}

}  // namespace landfix::tools::simulator
