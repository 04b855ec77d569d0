#include "ndt/voxel_grid.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

namespace landfix::ndt {
namespace {

TEST(VoxelGrid, GivesTheCentroidOfEveryCell) {
  std::mt19937_64 random(1);
  std::normal_distribution<float> normal(0.0F, 20.0F);
  VoxelGrid grid(2.0, 10000);
  std::map<std::tuple<int, int, int>, std::pair<Eigen::Vector3d, int>> cells;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3f p(normal(random), normal(random), 0.1F * normal(random));
    grid.add(p);
    const auto index = [](float v) { return static_cast<int>(std::floor(static_cast<double>(v) / 2.0)); };
    auto [cell, fresh] =
        cells.try_emplace({index(p.x()), index(p.y()), index(p.z())}, Eigen::Vector3d::Zero(), 0);
    cell->second.first += p.cast<double>();
    ++cell->second.second;
  }
  const auto centroids = grid.finish();
  ASSERT_EQ(centroids.size(), cells.size());
  for (const Eigen::Vector3f& c : centroids) {
    const auto index = [](float v) { return static_cast<int>(std::floor(static_cast<double>(v) / 2.0)); };
    const auto found = cells.find({index(c.x()), index(c.y()), index(c.z())});
    ASSERT_NE(found, cells.end());
    const auto& [sum, count] = found->second;
    EXPECT_LT((c.cast<double>() - sum / count).norm(), 1e-4);
    cells.erase(found);
  }
}

TEST(VoxelGrid, StartsAfreshAfterClear) {
  VoxelGrid grid(1.0, 100);
  grid.add({0.5F, 0.5F, 0.5F});
  EXPECT_EQ(grid.finish().size(), 1U);
  grid.clear();
  EXPECT_EQ(grid.finish().size(), 0U);
  grid.add({0.25F, 0.5F, 0.5F});
  EXPECT_EQ(grid.finish()[0].x(), 0.25F);
}

TEST(VoxelGrid, CountsWhatItCannotHold) {
  VoxelGrid grid(1.0, 3);
  for (int i = 0; i < 5; ++i) grid.add({static_cast<float>(i) + 0.5F, 0.0F, 0.0F});
  grid.add({0.6F, 0.0F, 0.0F});  // a cell that is there already
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  grid.add({kNan, 0.0F, 0.0F});
  grid.add({0.0F, std::numeric_limits<float>::infinity(), 0.0F});
  EXPECT_EQ(grid.finish().size(), 3U);
  EXPECT_EQ(grid.dropped_points(), 4U);
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
  EXPECT_LT(walk_m / static_cast<double>(centroids.size()), 4.0);
}

}  // namespace
}  // namespace landfix::ndt
