#include "ndt/voxel_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace landfix::ndt {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::vector<Eigen::Vector3f> random_points(std::uint64_t seed, std::size_t count, float sigma_m) {
  std::mt19937_64 random(seed);
  std::normal_distribution<float> normal(0.0F, sigma_m);
  std::vector<Eigen::Vector3f> points_m(count);
  for (Eigen::Vector3f& p : points_m) p = {normal(random), normal(random), 0.1F * normal(random)};
  return points_m;
}

/// Without points so near a border that rounding may take them or their centroid across it.
std::vector<Eigen::Vector3f> inside_cells(std::vector<Eigen::Vector3f> points_m, float leaf_m,
                                          float margin_m) {
  std::erase_if(points_m, [=](const Eigen::Vector3f& p) {
    return ((p.array() - leaf_m * (p.array() / leaf_m).round()).abs() < margin_m).any();
  });
  return points_m;
}

std::vector<Eigen::Vector3f> filtered(VoxelGrid& grid, std::span<const Eigen::Vector3f> points_m) {
  grid.clear();
  grid.add(points_m);
  const auto centroids = grid.finish();
  return {centroids.begin(), centroids.end()};
}

std::vector<Eigen::Vector3f> filtered(double leaf_m, std::span<const Eigen::Vector3f> points_m) {
  VoxelGrid grid(leaf_m, points_m.size());
  return filtered(grid, points_m);
}

using CellIndex = std::array<long, 3>;

CellIndex cell_of(const Eigen::Vector3d& point_m, double leaf_m) {
  const auto index = [leaf_m](double v) { return static_cast<long>(std::floor(v / leaf_m)); };
  return {index(point_m.x()), index(point_m.y()), index(point_m.z())};
}

/// Double precision, cell by cell.
std::map<CellIndex, Eigen::Vector3d> reference(std::span<const Eigen::Vector3f> points_m, double leaf_m) {
  std::map<CellIndex, std::pair<Eigen::Vector3d, int>> sums;
  for (const Eigen::Vector3f& point_m : points_m) {
    const Eigen::Vector3d p = point_m.cast<double>();
    auto [sum, fresh] = sums.try_emplace(cell_of(p, leaf_m), Eigen::Vector3d::Zero(), 0);
    sum->second.first += p;
    ++sum->second.second;
  }
  std::map<CellIndex, Eigen::Vector3d> centroids;
  for (const auto& [cell, sum] : sums) centroids[cell] = sum.first / sum.second;
  return centroids;
}

/// Each centroid within `tolerance_m` of its own of the reference, and none missing.
void expect_reference(std::span<const Eigen::Vector3f> points_m, double leaf_m, double tolerance_m) {
  auto expected = reference(points_m, leaf_m);
  const auto centroids = filtered(leaf_m, points_m);
  ASSERT_EQ(centroids.size(), expected.size());
  for (const Eigen::Vector3f& c : centroids) {
    const auto found = expected.find(cell_of(c.cast<double>(), leaf_m));
    ASSERT_NE(found, expected.end()) << c.transpose();
    EXPECT_LT((c.cast<double>() - found->second).norm(), tolerance_m);
    expected.erase(found);
  }
}

TEST(VoxelGrid, GivesTheCentroidOfEveryCell) {
  const auto points_m = random_points(1, 20000, 20.0F);
  for (const float leaf_m : {0.5F, 1.0F, 2.0F}) {
    const auto scan_m = inside_cells(points_m, leaf_m, 1e-4F * leaf_m);
    expect_reference(scan_m, static_cast<double>(leaf_m), 1e-4 * static_cast<double>(leaf_m));
  }
}

TEST(VoxelGrid, IsAsPreciseFarFromTheOriginAsSinglePrecision) {
  auto points_m = random_points(2, 20000, 20.0F);
  for (Eigen::Vector3f& p : points_m) p += Eigen::Vector3f(1e4F, -1e4F, 100.0F);
  // The step of single precision is 1 mm here.
  expect_reference(inside_cells(points_m, 2.0F, 0.004F), 2.0, 1e-3);
}

TEST(VoxelGrid, AveragesManyPointsOfOneCellWithoutDrift) {
  // GIVEN a hundred thousand times a number that single precision cannot add up
  const std::vector<Eigen::Vector3f> points_m(100'000, Eigen::Vector3f(151.1F, -199.9F, 0.3F));
  // THEN their mean is that number
  const auto centroids = filtered(2.0, points_m);
  ASSERT_EQ(centroids.size(), 1U);
  EXPECT_LT((centroids[0] - points_m[0]).norm(), 1e-4F);
}

TEST(VoxelGrid, ACellBeginsAtItsLowerBorder) {
  const std::vector<Eigen::Vector3f> points_m{
      {0.0F, 0.0F, 0.0F}, {1.99F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F}, {-0.01F, 0.0F, 0.0F}, {-2.0F, 0.0F, 0.0F}};
  const auto centroids = filtered(2.0, points_m);
  ASSERT_EQ(centroids.size(), 3U);
  EXPECT_NEAR(centroids[0].x(), -1.005F, 1e-4F);
  EXPECT_NEAR(centroids[1].x(), 0.995F, 1e-4F);
  EXPECT_EQ(centroids[2].x(), 2.0F);
}

TEST(VoxelGrid, ACellEndsAtItsUpperBorderHoweverNearAPointComesToIt) {
  const std::vector<Eigen::Vector3f> points_m{{-1e-30F, 0.0F, 0.0F},
                                              {-1.0F, 0.0F, 0.0F},
                                              {std::nextafter(2.0F, 0.0F), 0.0F, 0.0F},
                                              {2.0F, 0.0F, 0.0F}};
  const auto centroids = filtered(2.0, points_m);
  ASSERT_EQ(centroids.size(), 3U);
  EXPECT_NEAR(centroids[0].x(), -0.5F, 1e-4F);
  EXPECT_NEAR(centroids[1].x(), 2.0F, 1e-4F);
  EXPECT_EQ(centroids[2].x(), 2.0F);
}

TEST(VoxelGrid, DoesNotDependOnTheOrderOfPointsNorOnTheirPortions) {
  auto points_m = random_points(3, 5000, 20.0F);
  points_m[77].y() = kNan;
  const auto expected = filtered(1.0, points_m);
  VoxelGrid grid(1.0, 5000);
  std::mt19937_64 random(4);
  for (int round = 0; round < 10; ++round) {
    std::shuffle(points_m.begin(), points_m.end(), random);
    grid.clear();
    for (std::span<const Eigen::Vector3f> rest = points_m; !rest.empty();) {
      const std::size_t portion = std::min<std::size_t>(rest.size(), random() % 400);
      if (portion % 2 == 0) {
        grid.add(rest.first(portion));
      } else {
        for (const Eigen::Vector3f& point_m : rest.first(portion)) grid.add(point_m);
      }
      rest = rest.subspan(portion);
    }
    const auto centroids = grid.finish();
    // To the bit.
    EXPECT_TRUE(std::equal(centroids.begin(), centroids.end(), expected.begin(), expected.end()));
    EXPECT_EQ(grid.dropped_points(), 1U);
  }
}

TEST(VoxelGrid, StartsAfreshAfterClear) {
  VoxelGrid grid(1.0, 100);
  EXPECT_EQ(grid.finish().size(), 0U);
  grid.add({0.5F, 0.5F, 0.5F});
  EXPECT_EQ(grid.finish().size(), 1U);
  EXPECT_EQ(grid.finish().size(), 1U);
  grid.add({0.6F, 0.5F, kNan});
  grid.clear();
  EXPECT_EQ(grid.finish().size(), 0U);
  EXPECT_EQ(grid.dropped_points(), 0U);
  grid.add({0.25F, 0.5F, 0.5F});
  EXPECT_EQ(grid.finish()[0].x(), 0.25F);
}

TEST(VoxelGrid, LeavesOutPointsThatHaveNoCell) {
  auto points_m = random_points(5, 1000, 20.0F);
  const auto expected = filtered(1.0, points_m);
  const std::vector<Eigen::Vector3f> bad{{kNan, 0.0F, 0.0F},        {0.0F, kInfinity, 0.0F},
                                         {0.0F, 0.0F, -131'073.0F}, {131'072.0F, 0.0F, 0.0F},
                                         {1e30F, 0.0F, 0.0F},       {0.0F, kNan, kInfinity}};
  for (std::size_t i = 0; i < bad.size(); ++i) {
    points_m.insert(points_m.begin() + static_cast<std::ptrdiff_t>(150 * i), bad[i]);
  }
  VoxelGrid grid(1.0, 1000);
  EXPECT_EQ(filtered(grid, points_m), expected);
  EXPECT_EQ(grid.dropped_points(), bad.size());
}

TEST(VoxelGrid, CountsThePointsThatItCannotHold) {
  VoxelGrid grid(1.0, 3);
  // Five cells in three blocks, and two in a fourth.
  for (int i = 0; i < 7; ++i) grid.add({static_cast<float>(i) + 0.5F, 0.0F, 0.0F});
  grid.add({0.6F, 0.0F, 0.0F});  // a cell that is there already
  const auto centroids = grid.finish();
  ASSERT_EQ(centroids.size(), 3U);
  EXPECT_NEAR(centroids[0].x(), 0.55F, 1e-4F);
  EXPECT_EQ(grid.dropped_points(), 4U);
}

TEST(VoxelGrid, LeavesOutACellWithMorePointsThanItsSumHolds) {
  VoxelGrid grid(1.0, 10);
  std::vector<Eigen::Vector3f> points_m(VoxelGrid::kMostPointsOfCell, Eigen::Vector3f::Constant(0.99F));
  points_m.emplace_back(5.5F, 0.0F, 0.0F);
  ASSERT_EQ(filtered(grid, points_m).size(), 2U);
  EXPECT_NEAR(filtered(grid, points_m)[0].x(), 0.99F, 1e-4F);
  points_m.push_back(points_m[0]);
  ASSERT_EQ(filtered(grid, points_m).size(), 1U);
  EXPECT_EQ(filtered(grid, points_m)[0].x(), 5.5F);
  EXPECT_EQ(grid.dropped_points(), points_m.size() - 1);
}

TEST(VoxelGrid, HoldsAsManyPointsAsItsCapacityEvenIfEachHasACellOfItsOwn) {
  std::vector<Eigen::Vector3f> points_m;
  for (int i = 0; i < 1000; ++i) points_m.emplace_back(7.0F * static_cast<float>(i), 0.0F, 0.0F);
  VoxelGrid grid(1.0, points_m.size());
  EXPECT_EQ(filtered(grid, points_m).size(), points_m.size());
  EXPECT_EQ(grid.dropped_points(), 0U);
}

TEST(VoxelGrid, NeighboursInMemoryAreNeighboursInSpace) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<float> uniform(-50.0F, 50.0F);
  VoxelGrid grid(1.0, 20000);
  for (int i = 0; i < 10000; ++i) grid.add({uniform(random), uniform(random), 0.0F});
  const auto centroids = grid.finish();
  double walk_m = 0.0;
  for (std::size_t i = 1; i < centroids.size(); ++i) {
    walk_m += static_cast<double>((centroids[i] - centroids[i - 1]).norm());
  }
  // In random order the mean step would be 52 m.
  EXPECT_LT(walk_m / static_cast<double>(centroids.size()), 3.0);
}

}  // namespace
}  // namespace landfix::ndt
