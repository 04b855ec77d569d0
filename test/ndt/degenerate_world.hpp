// Worlds that do not hold every direction, for tests.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>

namespace landfix::ndt::test {

/// Floor and two walls, 8 m apart and 5 m high, along x from `from_m` to `to_m`; sampled at random.
[[nodiscard]] inline std::vector<Eigen::Vector3d> corridor(std::uint64_t seed, std::size_t points,
                                                           double from_m, double to_m) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::vector<Eigen::Vector3d> cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const double x = from_m + (to_m - from_m) * unit(random);
    Eigen::Vector3d p(x, 4.0, 5.0 * unit(random));
    if (i % 3 == 1) p.y() = -4.0;
    if (i % 3 == 2) p = {x, 8.0 * unit(random) - 4.0, 0.0};
    cloud.emplace_back(p + Eigen::Vector3d(noise(random), noise(random), noise(random)));
  }
  return cloud;
}

/// Level ground around the origin.
[[nodiscard]] inline std::vector<Eigen::Vector3d> field(std::uint64_t seed, std::size_t points,
                                                        double half_length_m) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::vector<Eigen::Vector3d> cloud;
  for (std::size_t i = 0; i < points; ++i)
    cloud.emplace_back(half_length_m * unit(random), half_length_m * unit(random), noise(random));
  return cloud;
}

/// Round and upright, 4 m high: `points` on their outsides.
[[nodiscard]] inline std::vector<Eigen::Vector3d> pillars(std::uint64_t seed, std::size_t points,
                                                          const std::vector<Eigen::Vector2d>& places_m) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Eigen::Vector3d> cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const Eigen::Vector2d& place_m = places_m[i % places_m.size()];
    const double angle = 6.28 * unit(random);
    cloud.emplace_back(place_m.x() + 0.2 * std::cos(angle), place_m.y() + 0.2 * std::sin(angle),
                       4.0 * unit(random));
  }
  return cloud;
}

[[nodiscard]] inline std::vector<Eigen::Vector3d> joined(std::vector<Eigen::Vector3d> a,
                                                         const std::vector<Eigen::Vector3d>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace landfix::ndt::test
