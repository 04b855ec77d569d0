#include "ndt/random_world.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "ndt/scan_filter.hpp"
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

std::vector<Eigen::Vector3d> random_town(std::uint64_t seed, const Eigen::Vector3d& origin_m, double slope) {
  constexpr double kHalf_m = 80.0;
  constexpr double kStep_m = 0.25;  // each cell of 1 m has points enough
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::vector<Eigen::Vector3d> town_m;
  const auto add = [&](double x_m, double y_m, double above_m) {
    const double z_m = above_m + slope * x_m;
    town_m.push_back(origin_m +
                     Eigen::Vector3d(x_m + noise(random), y_m + noise(random), z_m + noise(random)));
  };
  for (double x_m = -kHalf_m; x_m < kHalf_m; x_m += kStep_m) {
    for (double y_m = -kHalf_m; y_m < kHalf_m; y_m += kStep_m) add(x_m, y_m, 0.0);
  }
  for (int house = 0; house < 70; ++house) {
    const Eigen::Vector2d middle_m =
        kHalf_m * Eigen::Vector2d(2.0 * unit(random) - 1.0, 2.0 * unit(random) - 1.0);
    const Eigen::Vector2d half_m(3.0 + 7.0 * unit(random), 3.0 + 5.0 * unit(random));
    const Eigen::Rotation2Dd turn(std::numbers::pi * unit(random));
    const double high_m = 3.0 + 6.0 * unit(random);
    for (double along = -1.0; along < 1.0; along += kStep_m / half_m.maxCoeff()) {
      for (double z_m = 0.0; z_m < high_m; z_m += kStep_m) {
        for (const double side : {-1.0, 1.0}) {
          const Eigen::Vector2d a = middle_m + turn * Eigen::Vector2d(half_m.x() * along, half_m.y() * side);
          const Eigen::Vector2d b = middle_m + turn * Eigen::Vector2d(half_m.x() * side, half_m.y() * along);
          add(a.x(), a.y(), z_m);
          add(b.x(), b.y(), z_m);
        }
      }
    }
  }
  for (int pole = 0; pole < 120; ++pole) {
    const Eigen::Vector2d foot_m =
        kHalf_m * Eigen::Vector2d(2.0 * unit(random) - 1.0, 2.0 * unit(random) - 1.0);
    for (double z_m = 0.0; z_m < 5.0; z_m += 0.05) {
      const double angle_rad = 40.0 * z_m;
      add(foot_m.x() + 0.2 * std::cos(angle_rad), foot_m.y() + 0.2 * std::sin(angle_rad), z_m);
    }
  }
  return town_m;
}

Pose random_stand(std::mt19937_64& random, const std::vector<Eigen::Vector3d>& town_m, double slope) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  while (true) {
    const double x_m = 50.0 * unit(random);
    const Eigen::Vector3d place_m(x_m, 50.0 * unit(random), slope * x_m);
    const bool is_free = std::ranges::none_of(town_m, [&place_m](const Eigen::Vector3d& point_m) {
      return (point_m - place_m).head<2>().norm() < 3.0 && point_m.z() > place_m.z() + 1.0;
    });
    if (!is_free) continue;
    const Eigen::Matrix3d lean =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(-slope, 0.0, 1.0))
            .toRotationMatrix();
    Pose pose = Pose::Identity();
    pose.linear() = lean * to_rotation({.yaw_rad = std::numbers::pi * unit(random)});
    pose.translation() = place_m;
    return pose;
  }
}

std::vector<Eigen::Vector3f> scan_from(const std::vector<Eigen::Vector3d>& points_m, const Pose& pose,
                                       std::size_t every) {
  constexpr double kRange_m = 50.0;
  std::vector<Eigen::Vector3d> near_m;
  for (std::size_t i = 0; i < points_m.size(); i += every) {
    if ((points_m[i] - pose.translation()).norm() < kRange_m) near_m.push_back(points_m[i]);
  }
  ScanFilter filter({}, near_m.size());
  for (const Eigen::Vector3f& point_m : seen_from(near_m, pose)) filter.add(point_m, 0);
  const auto thinned = filter.finish();
  return {thinned.begin(), thinned.end()};
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
