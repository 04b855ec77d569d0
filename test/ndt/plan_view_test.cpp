#include "ndt/plan_view.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "ndt/plan_kernel.hpp"
#include "ndt/plan_points.hpp"
#include "ndt/random_world.hpp"

namespace landfix::ndt::test {
namespace {

TEST(GroundGrid, IsNeitherARoofNorAWall) {
  GroundGrid grid({-40.0, -40.0}, 20, 20);
  EXPECT_EQ(grid.height_m({0.0, 0.0}), std::numeric_limits<float>::infinity()) << "nothing seen yet";
  for (double x_m = -39.0; x_m < 40.0; x_m += 1.0) {
    for (double y_m = -39.0; y_m < 40.0; y_m += 1.0) {
      const bool is_roof = std::abs(x_m) < 6.0 && std::abs(y_m) < 6.0;
      grid.add({x_m, y_m, (is_roof ? 9.0 : 0.0) + 0.1 * x_m});
    }
  }
  grid.spread();
  EXPECT_NEAR(grid.height_m({30.0, 2.0}), 3.0, 0.3) << "the hill it is on";
  EXPECT_LT(grid.height_m({1.0, 1.0}), 3.0) << "no more than the steepest ground could rise to";
  EXPECT_EQ(grid.height_m({41.0, 0.0}), std::numeric_limits<float>::infinity()) << "beyond it";
  grid.clear();
  EXPECT_EQ(grid.height_m({30.0, 2.0}), std::numeric_limits<float>::infinity());
}

/// A wall along y at x = 20 on level ground, and a wood of poles at x < 0.
class PlanViewOfAWallAndAWood : public testing::Test {
 protected:
  static std::vector<Eigen::Vector3d> world() {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<Eigen::Vector3d> points_m;
    for (int i = 0; i < 200'000; ++i)
      points_m.emplace_back(120.0 * unit(random) - 60.0, 120.0 * unit(random) - 60.0, 0.05 * unit(random));
    for (int i = 0; i < 60'000; ++i)
      points_m.emplace_back(20.5 + 0.05 * unit(random), 120.0 * unit(random) - 60.0, 5.0 * unit(random));
    for (int i = 0; i < 200'000; ++i)
      points_m.emplace_back(-10.0 - 50.0 * unit(random), 120.0 * unit(random) - 60.0,
                            2.0 + 2.0 * unit(random));
    return points_m;
  }

  [[nodiscard]] std::uint8_t at(std::size_t level, double x_m, double y_m) const {
    const Eigen::Vector2d cell = (Eigen::Vector2d(x_m, y_m) - plan_.corner_m()) / plan_.cell_m();
    return plan_.level(level)[static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(plan_.width()) +
                              static_cast<std::size_t>(cell.x())];
  }

  MapImage image_ = build_map(world(), 1.0);
  VoxelMap map_{image_.bytes()};
  PlanView plan_{map_};
};

TEST_F(PlanViewOfAWallAndAWood, WhatIsRareTellsMore) {
  EXPECT_EQ(at(0, 10.5, 0.5), 0) << "the ground is nothing";
  EXPECT_EQ(at(0, 20.5, 0.5), 5)
      << "a wall, as surprising as what stands on the map is on the whole: 4 log2(1 / 0.42)";
  EXPECT_LT(at(0, -40.5, 0.5), 4) << "one tree of a wood";
  EXPECT_GT(at(0, -40.5, 0.5), 0);
  EXPECT_EQ(at(0, 19.5, 0.5), 5) << "a point seen from a cell may fall into it or the next";
  EXPECT_EQ(at(0, 18.5, 0.5), 0);
  EXPECT_NEAR(plan_.area_m2(), 120.0 * 120.0, 300.0);
}

TEST_F(PlanViewOfAWallAndAWood, ANodeBoundsAllPlacesInIt) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> side_m(-50.0, 50.0);
  for (int i = 0; i < 500; ++i) {
    const double x_m = side_m(random);
    const double y_m = side_m(random);
    for (std::size_t level = 1; level < PlanView::kLevels; ++level) {
      std::uint8_t greatest = 0;
      for (int dx = 0; dx < 1 << level; ++dx) {
        for (int dy = 0; dy < 1 << level; ++dy) greatest = std::max(greatest, at(0, x_m + dx, y_m + dy));
      }
      EXPECT_EQ(at(level, x_m, y_m), greatest);
    }
  }
}

TEST_F(PlanViewOfAWallAndAWood, TheTopRowsAreTheTopLevel) {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<std::int32_t> away(-PlanView::kMarginCells + 2, PlanView::kMarginCells - 2);
  constexpr std::int32_t kFirst = PlanView::kMarginCells / PlanView::kTopCells;
  std::uniform_int_distribution<std::int32_t> node_x(kFirst, plan_.top_nodes_x() - kFirst - 1);
  std::uniform_int_distribution<std::int32_t> node_y(kFirst, plan_.top_nodes_y() - kFirst - 1);
  for (int i = 0; i < 1000; ++i) {
    const std::int32_t nx = node_x(random);
    const std::int32_t ny = node_y(random);
    const std::int32_t dx = away(random);
    const std::int32_t dy = away(random);
    const std::int32_t cell = (ny * PlanView::kTopCells + dy) * plan_.width() + nx * PlanView::kTopCells + dx;
    EXPECT_EQ(plan_.top_rows()[ny * plan_.top_stride() + nx + plan_.top_offset(dx, dy)],
              plan_.level(PlanView::kTop)[static_cast<std::size_t>(cell)]);
  }
}

TEST(PlanView, AMapThatIsTooWideIsRefused) {
  std::vector<Eigen::Vector3d> points_m = random_yard(1, 20'000);
  for (const Eigen::Vector3d& point_m : random_yard(2, 20'000, 0.02, {1e6, 1e6, 0.0}))
    points_m.push_back(point_m);
  const MapImage image = build_map(points_m, 1.0);
  EXPECT_THROW(PlanView{VoxelMap(image.bytes())}, std::runtime_error);
}

TEST(PlanView, OfNothingIsEmpty) {
  const PlanView plan{VoxelMap()};
  EXPECT_EQ(plan.area_m2(), 0.0);
}

TEST(PlanKernel, IsThePlainSum) {
  std::mt19937_64 random(4);
  std::uniform_int_distribution<int> weight(0, PlanView::kMostWeight);
  std::vector<std::uint8_t> bytes(5000);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(weight(random));
  for (const std::size_t count : std::to_array<std::size_t>({0, 1, 15, 16, 17, PlanPoints::kMost})) {
    std::vector<std::int32_t> offsets(count);
    for (std::int32_t& offset : offsets)
      offset = std::uniform_int_distribution<std::int32_t>(-1000, 1000)(random);
    NodeScores scores;
    score_nodes(bytes.data() + 2000, offsets, scores);
    for (std::size_t node = 0; node < scores.size(); ++node) {
      unsigned sum = 0;
      for (const std::int32_t offset : offsets) sum += bytes[static_cast<std::size_t>(2000 + offset) + node];
      EXPECT_EQ(scores[node], sum) << node << " of " << count;
    }
  }
}

TEST(PlanPoints, AWallCountsOnceAndTheGroundNot) {
  std::vector<Eigen::Vector3f> points_m;
  for (float y_m = -20.25F; y_m < 20.0F; y_m += 0.5F) {
    for (float z_m = 0.0F; z_m < 6.0F; z_m += 0.5F) points_m.emplace_back(10.5F, y_m, z_m);
    for (float x_m = -9.75F; x_m < 10.0F; x_m += 0.5F) points_m.emplace_back(x_m, y_m, 0.0F);
  }
  points_m.emplace_back(500.0F, 0.0F, 3.0F);
  points_m.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 3.0F);
  PlanPoints points(1.0);
  points.take(points_m);
  EXPECT_EQ(points.cells().size(), 41U);
  for (const Eigen::Vector2f& cell : points.cells()) EXPECT_FLOAT_EQ(cell.x(), 10.5F);
  points.take({});
  EXPECT_TRUE(points.cells().empty());
}

}  // namespace
}  // namespace landfix::ndt::test
