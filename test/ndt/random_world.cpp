#include "ndt/random_world.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ndt/spatial_sort.hpp"
#include "ndt/voxel_map_builder.hpp"

namespace landfix::ndt::test {

std::vector<Eigen::Vector3d> random_yard(std::uint64_t seed, std::size_t points, double noise_m,
                                         const Eigen::Vector3d& origin_m) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, noise_m);
  constexpr double kHalf_m = 15.0;
  const double wall_y_m = 8.0 + 4.0 * unit(random);
  const double wall_x_m = 9.0 + 4.0 * unit(random);
  std::vector<Eigen::Vector2d> poles;
  for (int i = 0; i < 8; ++i)
    poles.emplace_back(kHalf_m * (2.0 * unit(random) - 1.0), 8.0 * (2.0 * unit(random) - 1.0));

  std::vector<Eigen::Vector3d> cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const double u = 2.0 * unit(random) - 1.0;
    const double v = unit(random);
    Eigen::Vector3d p;
    switch (i % 4) {
      case 0:
        p = {kHalf_m * u, 10.0 * (2.0 * v - 1.0), 0.1 * std::sin(kHalf_m * u)};
        break;
      case 1:
        p = {kHalf_m * u, wall_y_m, 5.0 * v};
        break;
      case 2:
        p = {wall_x_m, 10.0 * u, 5.0 * v};
        break;
      default: {
        const Eigen::Vector2d& pole = poles[i / 4 % poles.size()];
        p = {pole.x() + 0.15 * std::cos(3.0 * u), pole.y() + 0.15 * std::sin(3.0 * u), 4.0 * v};
      }
    }
    cloud.emplace_back(origin_m + p + Eigen::Vector3d(noise(random), noise(random), noise(random)));
  }
  return cloud;
}

MapImage build_map(const std::vector<Eigen::Vector3d>& points_m, double resolution_m) {
  VoxelMapBuilder builder(resolution_m, points_m.size());
  for (const Eigen::Vector3d& point_m : points_m) builder.add(point_m);
  return builder.build();
}

std::vector<Eigen::Vector3f> seen_from(const std::vector<Eigen::Vector3d>& points_m, const Pose& pose) {
  std::vector<Eigen::Vector3f> seen;
  const Pose inverse = pose.inverse();
  for (const Eigen::Vector3d& point_m : points_m) seen.emplace_back((inverse * point_m).cast<float>());
  return seen;
}

std::vector<Eigen::Vector3f> in_spatial_order(std::vector<Eigen::Vector3f> points_m) {
  const auto code = [](const Eigen::Vector3f& point_m) {
    constexpr float kCell_m = 2.0F;
    constexpr float kBias_m = 1000.0F;
    const Eigen::Vector3f cell = (point_m.array() + kBias_m) / kCell_m;
    return morton_code(static_cast<std::uint64_t>(cell.x()), static_cast<std::uint64_t>(cell.y()),
                       static_cast<std::uint64_t>(cell.z()));
  };
  std::ranges::stable_sort(points_m, {}, code);
  return points_m;
}

Pose random_pose(std::mt19937_64& random, double translation_m, double rotation_rad) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto direction = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  };
  Pose pose = Pose::Identity();
  pose.translation() = translation_m * unit(random) * direction();
  pose.linear() = rotation_exp(rotation_rad * unit(random) * direction());
  return pose;
}

}  // namespace landfix::ndt::test
