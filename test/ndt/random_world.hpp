// Small worlds for the tests of matching: surfaces with structure in every direction, sampled at random.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "ndt/map_image.hpp"
#include "ndt/pose.hpp"

namespace landfix::ndt::test {

/// Points on the ground, two walls and some poles of a room-sized yard, with `noise_m` of noise; `origin_m`
/// moves it all. Different seeds give different points of different worlds.
[[nodiscard]] std::vector<Eigen::Vector3d> random_yard(
    std::uint64_t seed, std::size_t points, double noise_m = 0.02,
    const Eigen::Vector3d& origin_m = Eigen::Vector3d::Zero());

/// Points on the ground, the walls of houses and some poles of a town, 160 m a side, with its middle at
/// `origin_m`.
[[nodiscard]] std::vector<Eigen::Vector3d> random_town(
    std::uint64_t seed, const Eigen::Vector3d& origin_m = Eigen::Vector3d::Zero(), double slope = 0.0);
/// A place in it that no house stands on, level or on its slope, with any heading.
[[nodiscard]] Pose random_stand(std::mt19937_64& random, const std::vector<Eigen::Vector3d>& town_m,
                                double slope = 0.0);
/// Of the points, those within 50 m, each so many, thinned as a filter does.
[[nodiscard]] std::vector<Eigen::Vector3f> scan_from(const std::vector<Eigen::Vector3d>& points_m,
                                                     const Pose& pose, std::size_t every = 11);

[[nodiscard]] MapImage build_map(const std::vector<Eigen::Vector3d>& points_m, double resolution_m);

/// The points as a scanner at `pose` would see them.
[[nodiscard]] std::vector<Eigen::Vector3f> seen_from(const std::vector<Eigen::Vector3d>& points_m,
                                                     const Pose& pose);

/// As a filter hands scans over: neighbours near each other.
[[nodiscard]] std::vector<Eigen::Vector3f> in_spatial_order(std::vector<Eigen::Vector3f> points_m);

/// Up to `translation_m` and `rotation_rad` away from the identity.
[[nodiscard]] Pose random_pose(std::mt19937_64& random, double translation_m, double rotation_rad);

}  // namespace landfix::ndt::test
