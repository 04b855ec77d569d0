#include "ndt/scan_filter.hpp"

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

struct RingPoint {
  Eigen::Vector3f point_m;
  std::uint16_t ring;
};

std::vector<RingPoint> random_scan(std::uint64_t seed, std::size_t count) {
  std::mt19937_64 random(seed);
  std::normal_distribution<float> normal(0.0F, 15.0F);
  std::vector<RingPoint> scan(count);
  for (RingPoint& p : scan) {
    p = {{normal(random), normal(random), 0.1F * normal(random)}, static_cast<std::uint16_t>(random() % 16)};
  }
  return scan;
}

std::vector<Eigen::Vector3f> filtered(ScanFilter& filter, const std::vector<RingPoint>& scan) {
  filter.clear();
  for (const RingPoint& p : scan) filter.add(p.point_m, p.ring);
  const auto points_m = filter.finish();
  return {points_m.begin(), points_m.end()};
}

using RingCell = std::array<long, 4>;

RingCell cell_of(const Eigen::Vector3f& p, double leaf_m, long ring) {
  const auto index = [&](float v) { return static_cast<long>(std::floor(static_cast<double>(v) / leaf_m)); };
  return {index(p.x()), index(p.y()), index(p.z()), ring};
}

TEST(ScanFilter, HasTheNamesOfTheConfiguration) {
  EXPECT_EQ(find_filter("voxel"), FilterKind::voxel);
  EXPECT_EQ(find_filter("ring"), FilterKind::ring);
  EXPECT_EQ(find_filter("entropy"), FilterKind::entropy);
  EXPECT_EQ(find_filter("Voxel"), std::nullopt);
}

TEST(ScanFilter, VoxelGivesWhatAVoxelGridGives) {
  const auto scan = random_scan(1, 10000);
  VoxelGrid grid(1.0, 10000);
  for (const RingPoint& p : scan) grid.add(p.point_m);
  const auto expected = grid.finish();
  ScanFilter filter({.leaf_m = 1.0}, 10000);
  const auto points_m = filtered(filter, scan);
  EXPECT_TRUE(std::equal(points_m.begin(), points_m.end(), expected.begin(), expected.end()));
}

TEST(ScanFilter, RingGivesTheCentroidOfEachRingInEachCell) {
  auto scan = random_scan(2, 20000);
  // Rounding may take a centroid across a border.
  std::erase_if(scan, [](const RingPoint& p) {
    return ((p.point_m.array() - 2.0F * (0.5F * p.point_m.array()).round()).abs() < 2e-4F).any();
  });
  std::map<RingCell, std::pair<Eigen::Vector3d, int>> sums;
  for (const RingPoint& p : scan) {
    auto& [sum, count] =
        sums.try_emplace(cell_of(p.point_m, 2.0, p.ring), Eigen::Vector3d::Zero(), 0).first->second;
    sum += p.point_m.cast<double>();
    ++count;
  }
  ScanFilter filter({.kind = FilterKind::ring}, 20000);
  const auto points_m = filtered(filter, scan);
  ASSERT_EQ(points_m.size(), sums.size());
  // A centroid does not tell its ring: of those in its cell, one must be its.
  for (const Eigen::Vector3f& point_m : points_m) {
    bool found = false;
    for (long ring = 0; ring < 16 && !found; ++ring) {
      const auto at = sums.find(cell_of(point_m, 2.0, ring));
      if (at == sums.end()) continue;
      const auto& [sum, count] = at->second;
      found = (sum / count - point_m.cast<double>()).norm() < 2e-4;
      if (found) sums.erase(at);
    }
    EXPECT_TRUE(found) << point_m.transpose();
  }
}

TEST(ScanFilter, RingTellsAllRingsOfASensorApart) {
  ScanFilter filter({.kind = FilterKind::ring}, 1000);
  std::vector<RingPoint> scan;
  for (std::uint16_t ring = 0; ring < 541; ++ring) {
    for (int i = 0; i < 3; ++i) scan.push_back({{0.5F, 0.5F, 0.5F}, ring});
  }
  EXPECT_EQ(filtered(filter, scan).size(), 541U);
  EXPECT_EQ(filter.dropped_points(), 0U);
}

/// Ten points in each of 20 cells along x, in every second of which they lie on a wall.
std::vector<RingPoint> walls_and_bushes() {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  std::vector<RingPoint> scan;
  for (int cell = 0; cell < 20; ++cell) {
    for (int i = 0; i < 10; ++i) {
      const float depth = cell % 2 == 0 ? 0.5F : uniform(random);
      scan.push_back({{static_cast<float>(cell) + uniform(random), depth, uniform(random)}, 0});
    }
  }
  return scan;
}

TEST(ScanFilter, EntropyKeepsTheWallsAndLeavesTheBushes) {
  ScanFilter filter({.kind = FilterKind::entropy, .leaf_m = 1.0, .entropy_share = 0.5}, 100);
  const auto points_m = filtered(filter, walls_and_bushes());
  ASSERT_EQ(points_m.size(), 10U);
  for (const Eigen::Vector3f& p : points_m) EXPECT_EQ(static_cast<int>(p.x()) % 2, 0) << p.transpose();
}

TEST(ScanFilter, EntropyIsThatOfTheNormalDistribution) {
  // GIVEN many points of a known distribution in one cell, far from the origin
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0.0, 0.1);
  VoxelGrid grid(4.0, 10, {.with_entropy = true});
  for (int i = 0; i < 50'000; ++i) {
    const Eigen::Vector3d p(101.5 + normal(random), -98.0 + 2.0 * normal(random), 2.0 + 0.5 * normal(random));
    grid.add(p.cast<float>());
  }
  ASSERT_EQ(grid.finish().size(), 1U);
  // THEN its entropy is that of the distribution, 2 cm of range noise added
  const auto term = [](double sigma_m) { return std::log(2.0 * M_PI * M_E * (sigma_m * sigma_m + 4e-4)); };
  EXPECT_NEAR(grid.entropies()[0], 0.5 * (term(0.1) + term(0.2) + term(0.05)), 0.02);
}

TEST(ScanFilter, EntropyIsUnknownOfFewPoints) {
  ScanFilter filter({.kind = FilterKind::entropy, .leaf_m = 1.0, .entropy_share = 1.0}, 100);
  EXPECT_EQ(filtered(filter, {}).size(), 0U);
  const std::vector<RingPoint> five(5, {{0.5F, 0.5F, 0.5F}, 0});
  EXPECT_EQ(filtered(filter, five).size(), 0U);
  const std::vector<RingPoint> six(6, {{0.5F, 0.5F, 0.5F}, 0});
  EXPECT_EQ(filtered(filter, six).size(), 1U);
  EXPECT_EQ(filter.dropped_points(), 0U);
}

class EveryFilter : public testing::TestWithParam<FilterKind> {};

TEST_P(EveryFilter, DoesNotDependOnTheOrderOfThePoints) {
  auto scan = random_scan(5, 20000);
  scan[100].point_m.x() = std::numeric_limits<float>::quiet_NaN();
  ScanFilter filter({.kind = GetParam(), .leaf_m = 4.0}, 20000);
  const auto expected = filtered(filter, scan);
  EXPECT_FALSE(expected.empty());
  std::mt19937_64 random(6);
  for (int round = 0; round < 3; ++round) {
    std::shuffle(scan.begin(), scan.end(), random);
    EXPECT_EQ(filtered(filter, scan), expected);
    EXPECT_EQ(filter.dropped_points(), 1U);
  }
}

TEST_P(EveryFilter, TakesManyPointsAtOnceAsOneByOne) {
  const auto scan = random_scan(9, 5000);
  std::vector<Eigen::Vector3f> points_m;
  std::vector<std::uint16_t> rings;
  for (const RingPoint& p : scan) {
    points_m.push_back(p.point_m);
    rings.push_back(p.ring);
  }
  ScanFilter filter({.kind = GetParam(), .leaf_m = 4.0}, 5000);
  const auto expected = filtered(filter, scan);
  filter.clear();
  filter.add(points_m, rings);
  const auto at_once = filter.finish();
  EXPECT_TRUE(std::equal(at_once.begin(), at_once.end(), expected.begin(), expected.end()));
}

TEST_P(EveryFilter, GivesNoMoreThanItsCapacityAndCountsTheRest) {
  const auto scan = random_scan(7, 20000);
  ScanFilter filter({.kind = GetParam()}, 500);
  EXPECT_LE(filtered(filter, scan).size(), 500U);
  EXPECT_GT(filter.dropped_points(), 1000U);
  filter.clear();
  EXPECT_EQ(filter.finish().size(), 0U);
  EXPECT_EQ(filter.dropped_points(), 0U);
}

TEST_P(EveryFilter, NeighboursInMemoryAreNeighboursInSpace) {
  ScanFilter filter({.kind = GetParam(), .leaf_m = 4.0, .entropy_share = 1.0}, 20000);
  const auto points_m = filtered(filter, random_scan(8, 20000));
  double walk_m = 0.0;
  for (std::size_t i = 1; i < points_m.size(); ++i)
    walk_m += static_cast<double>((points_m[i] - points_m[i - 1]).norm());
  // In random order the mean step would be 27 m.
  EXPECT_LT(walk_m / static_cast<double>(points_m.size()), 8.0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryFilter,
                         testing::Values(FilterKind::voxel, FilterKind::ring, FilterKind::entropy),
                         [](const auto& kind) {
                           return std::string(kFilterNames[static_cast<std::size_t>(kind.param)]);
                         });

}  // namespace
}  // namespace landfix::ndt
