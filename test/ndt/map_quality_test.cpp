#include "ndt/map_quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace landfix::ndt {
namespace {

using Cloud = std::vector<Eigen::Vector3f>;

[[nodiscard]] MapQuality quality_of(const Cloud& cloud, double radius_m) {
  const NeighbourTree tree(cloud);
  QualityProbe probe(tree, radius_m);
  MapQuality quality;
  for (std::size_t i = 0; i < cloud.size(); ++i) quality.add(probe.at(i));
  return quality;
}

/// By the definitions, without a tree and in another order.
[[nodiscard]] MapQuality brute_force(const Cloud& cloud, double radius_m) {
  MapQuality quality;
  for (const Eigen::Vector3f& centre : cloud) {
    Eigen::Matrix3Xd near(3, 0);
    for (const Eigen::Vector3f& point : cloud) {
      if ((point.cast<double>() - centre.cast<double>()).norm() > radius_m) continue;
      near.conservativeResize(Eigen::NoChange, near.cols() + 1);
      near.rightCols<1>() = point.cast<double>();
    }
    ++quality.points;
    if (near.cols() < 5) {
      ++quality.skipped;
      continue;
    }
    const Eigen::Vector3d mean = near.rowwise().mean();
    near.colwise() -= mean;
    const Eigen::Matrix3d covariance = near * near.transpose() / static_cast<double>(near.cols());
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU);
    quality.entropy_sum +=
        0.5 * std::log((2.0 * std::numbers::pi * std::numbers::e * covariance).determinant());
    Eigen::VectorXd distances = (svd.matrixU().col(2).transpose() * near).cwiseAbs().transpose();
    std::sort(distances.begin(), distances.end());
    const double rank = 0.75 * static_cast<double>(distances.size() - 1);
    const auto below = static_cast<Eigen::Index>(rank);
    const Eigen::Index above = std::min(below + 1, distances.size() - 1);
    quality.plane_variance_sum_m +=
        distances[below] + (rank - static_cast<double>(below)) * (distances[above] - distances[below]);
  }
  return quality;
}

TEST(MapQualityTest, IsThatOfBruteForce) {
  std::mt19937_64 random(7);
  std::normal_distribution<float> normal(0.0F, 1.0F);
  for (const double radius_m : {0.3, 0.8, 2.0}) {
    Cloud cloud(700);
    for (Eigen::Vector3f& point : cloud)
      point = {3.0F * normal(random), 3.0F * normal(random), 0.2F * normal(random)};
    const MapQuality expected = brute_force(cloud, radius_m);
    const MapQuality found = quality_of(cloud, radius_m);
    EXPECT_EQ(found.points, expected.points);
    EXPECT_EQ(found.skipped, expected.skipped);
    EXPECT_NEAR(found.mean_map_entropy(), expected.mean_map_entropy(), 1e-6);
    EXPECT_NEAR(found.mean_plane_variance_m(), expected.mean_plane_variance_m(), 1e-6);
  }
}

/// Over points that are farther than the radius from the edge of what was sampled.
template <class IsInterior>
[[nodiscard]] MapQuality interior_quality(const Cloud& cloud, const IsInterior& is_interior) {
  const NeighbourTree tree(cloud);
  QualityProbe probe(tree, 1.0);
  MapQuality quality;
  constexpr std::size_t kEach = 5;  // they overlap: more tell little more
  for (std::size_t i = 0; i < cloud.size(); i += kEach)
    if (is_interior(cloud[i])) quality.add(probe.at(i));
  return quality;
}

TEST(MapQualityTest, OfAUniformVolumeIsThatOfABall) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<float> place(-2.0F, 2.0F);
  Cloud cloud(60'000);  // 940 a cubic metre
  for (Eigen::Vector3f& point : cloud) point = {place(random), place(random), place(random)};
  const MapQuality quality = interior_quality(
      cloud, [](const Eigen::Vector3f& point) { return point.cwiseAbs().maxCoeff() < 0.9F; });
  // Each axis has a variance of r^2 / 5.
  const double analytic = 0.5 * (3.0 * std::log(2.0 * std::numbers::pi * std::numbers::e / 5.0));
  EXPECT_NEAR(analytic, 1.8427, 1e-4);
  EXPECT_GT(quality.points, 1'000U);
  EXPECT_EQ(quality.skipped, 0U);
  EXPECT_NEAR(quality.mean_map_entropy(), analytic, 0.006);  // of the sampling: neighbourhoods overlap
}

TEST(MapQualityTest, OfANoisyPlaneIsTheNoise) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<float> place(-4.0F, 4.0F);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  Cloud cloud(64'000);  // 1000 a square metre
  for (Eigen::Vector3f& point : cloud) point = {place(random), place(random), noise(random)};
  const MapQuality quality = interior_quality(
      cloud, [](const Eigen::Vector3f& point) { return point.head<2>().cwiseAbs().maxCoeff() < 2.9F; });
  EXPECT_GT(quality.points, 4'000U);
  EXPECT_NEAR(quality.mean_map_entropy(), -1.0415, 0.006);
  EXPECT_NEAR(quality.mean_plane_variance_m(), 0.0230, 0.0001);
}

TEST(MapQualityTest, SkipsAndCountsPointsThatHaveNone) {
  const auto line = [](float x_m, std::size_t count) {
    Cloud cloud(count);
    for (std::size_t i = 0; i < count; ++i) cloud[i] = {x_m, 0.01F * static_cast<float>(i), 0.0F};
    return cloud;
  };
  EXPECT_EQ(quality_of(line(0.0F, 4), 1.0).skipped, 4U) << "too few";
  EXPECT_EQ(quality_of(line(0.0F, 6), 1.0).skipped, 6U) << "a line";
  EXPECT_EQ(quality_of(Cloud(6, Eigen::Vector3f(1.0F, 2.0F, 3.0F)), 1.0).skipped, 6U) << "one place";
  EXPECT_TRUE(std::isnan(quality_of({}, 1.0).mean_map_entropy()));
  Cloud tetrahedron{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.3F, 0.3F, 0.3F}};
  const MapQuality quality = quality_of(tetrahedron, 2.0);
  EXPECT_EQ(quality.skipped, 0U);
  EXPECT_TRUE(std::isfinite(quality.mean_map_entropy()));
}

}  // namespace
}  // namespace landfix::ndt
