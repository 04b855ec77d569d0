#include "ndt/map_window.hpp"

#include <algorithm>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ndt/map_file.hpp"
#include "ndt/random_world.hpp"
#include "ndt/voxel_map_builder.hpp"

namespace landfix::ndt::test {
namespace {

/// Yards in a row along x, each 40 m from the next, at 0.5 m: tiles of 8 m.
class MapWindowTest : public testing::Test {
 protected:
  static constexpr int kYards = 6;

  [[nodiscard]] static MapImage make() {
    std::vector<Eigen::Vector3d> points;
    for (int yard = 0; yard < kYards; ++yard) {
      const auto more = random_yard(static_cast<std::uint64_t>(yard), 20000, 0.02, middle_m(yard));
      points.insert(points.end(), more.begin(), more.end());
    }
    return build_map(points, 0.5);
  }
  [[nodiscard]] static Eigen::Vector3d middle_m(int yard) { return {40.0 * yard - 100.0, 3.0, 0.0}; }

  /// Reads from `file_`, except what fails.
  [[nodiscard]] ReadAt read_at() {
    return [this](std::uint64_t offset, std::span<std::byte> into) {
      if (offset + into.size() > file_.size()) return false;
      std::copy_n(file_.begin() + static_cast<std::ptrdiff_t>(offset), into.size(), into.begin());
      return true;
    };
  }
  [[nodiscard]] WindowAssembler assembler(double radius_m) {
    return {read_map_directory(read_at(), file_.size(), "row.ndt"), read_at(), radius_m};
  }

  MapImage whole_ = make();
  VoxelMap map_{whole_.bytes()};
  std::vector<std::byte> file_{whole_.bytes().begin(), whole_.bytes().end()};
  MapMemory memory_{whole_.bytes().size()};
};

TEST_F(MapWindowTest, AWindowThatReachesEverywhereIsTheMap) {
  const WindowContent content = assembler(1e6).assemble(memory_.bytes(), Eigen::Vector3d::Zero());
  EXPECT_EQ(content.tiles, map_.header().tile_count);
  EXPECT_EQ(content.voxels, map_.voxels().size());
  EXPECT_EQ(content.tiles_not_fitting + content.tiles_unreadable, 0U);
  const VoxelMap window(memory_.bytes());
  ASSERT_EQ(window.voxels().size(), map_.voxels().size());
  EXPECT_EQ(window.resolution_m(), map_.resolution_m());
  for (const BlockEntry& block : map_.blocks()) {
    if (block.occupancy == 0) continue;
    const BlockEntry* const found = window.find_block(block.key);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->occupancy, block.occupancy);
    EXPECT_EQ(found->first_voxel, block.first_voxel);
  }
  EXPECT_TRUE(std::ranges::equal(std::as_bytes(window.voxels()), std::as_bytes(map_.voxels())));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::span ours(window.mean_column_m(axis), map_.voxels().size());
    EXPECT_TRUE(std::ranges::equal(ours, std::span(map_.mean_column_m(axis), map_.voxels().size())));
  }
}

TEST_F(MapWindowTest, HoldsEveryBlockWithinTheRadiusAndNoneFarBeyond) {
  WindowAssembler windows = assembler(30.0);
  for (int yard = 0; yard < kYards; ++yard) {
    (void)windows.assemble(memory_.bytes(), middle_m(yard));
    const VoxelMap window(memory_.bytes());
    visit_voxels(map_, [&](const Voxel& /*voxel*/, const Eigen::Vector3d& mean_m) {
      const double away_m = (mean_m - middle_m(yard)).head<2>().norm();
      const bool is_there = window.find_block(block_key(cell_of(mean_m / 0.5))) != nullptr;
      EXPECT_TRUE(is_there || away_m >= 30.0) << away_m;
      EXPECT_TRUE(!is_there || away_m <= 30.0 + 1.5 * 8.0) << away_m;
    });
  }
}

TEST_F(MapWindowTest, WhereTheMapIsNotItIsEmpty) {
  const WindowContent content = assembler(30.0).assemble(memory_.bytes(), {5000.0, 0.0, 0.0});
  EXPECT_EQ(content.tiles, 0U);
  const VoxelMap window(memory_.bytes());
  EXPECT_TRUE(window.voxels().empty());
  EXPECT_EQ(window.find_block(map_.blocks()[0].key), nullptr);
}

TEST_F(MapWindowTest, WithoutRoomForAllTheNearestTilesAreTakenAndTheOthersCounted) {
  WindowAssembler windows = assembler(1e6);
  const Eigen::Vector3d centre_m = middle_m(2);
  std::size_t tiles_before = 0;
  for (const std::size_t share : {16U, 8U, 4U, 2U}) {
    const auto memory = memory_.bytes().first(file_.size() / share);
    const WindowContent content = windows.assemble(memory, centre_m);
    EXPECT_GT(content.tiles, tiles_before);
    tiles_before = content.tiles;
    EXPECT_EQ(content.tiles + content.tiles_not_fitting, map_.header().tile_count);
    const VoxelMap window(memory);
    EXPECT_LE(window.header().total_bytes, memory.size());
    // Within the nearest missing voxel's distance, none is missing.
    double nearest_missing_m = 1e9;
    double farthest_there_m = 0.0;
    visit_voxels(map_, [&](const Voxel& /*voxel*/, const Eigen::Vector3d& mean_m) {
      const double away_m = (mean_m - centre_m).head<2>().norm();
      if (window.find_block(block_key(cell_of(mean_m / 0.5))) != nullptr) {
        farthest_there_m = std::max(farthest_there_m, away_m);
      } else {
        nearest_missing_m = std::min(nearest_missing_m, away_m);
      }
    });
    EXPECT_LT(farthest_there_m, nearest_missing_m + 1.5 * 8.0) << "a tile's diagonal";
  }
}

TEST_F(MapWindowTest, ATileThatIsDamagedOrMissingIsLeftOutAndCountedAndTheRestIsThere) {
  WindowAssembler windows = assembler(1e6);
  const MapLayout layout(map_.header());
  const auto* const tiles = reinterpret_cast<const TileEntry*>(whole_.bytes().data() + layout.tiles);
  const TileEntry& damaged = tiles[map_.header().tile_count / 2];
  const auto blocks_there = [&] {
    const VoxelMap window(memory_.bytes());
    return std::ranges::count_if(window.blocks(),
                                 [](const BlockEntry& block) { return block.occupancy != 0; });
  };
  file_[layout.voxels + damaged.first_voxel * sizeof(Voxel) + 3] ^= std::byte{1};
  WindowContent content = windows.assemble(memory_.bytes(), Eigen::Vector3d::Zero());
  EXPECT_EQ(content.tiles_unreadable, 1U);
  EXPECT_EQ(content.tiles, map_.header().tile_count - 1);
  EXPECT_EQ(blocks_there(), static_cast<std::ptrdiff_t>(map_.header().block_count - damaged.blocks));
  visit_voxels(VoxelMap(memory_.bytes()), [&](const Voxel& voxel, const Eigen::Vector3d& mean_m) {
    EXPECT_GE(voxel.count, kMinVoxelPoints);
    EXPECT_NE(map_.find_block(block_key(cell_of(mean_m / 0.5))), nullptr);
  });

  // The file became shorter while it was open.
  file_.resize(layout.voxels + tiles[1].first_voxel * sizeof(Voxel));
  content = windows.assemble(memory_.bytes(), Eigen::Vector3d::Zero());
  EXPECT_EQ(content.tiles, 1U);
  EXPECT_EQ(content.tiles_unreadable, map_.header().tile_count - 1);
  EXPECT_EQ(blocks_there(), static_cast<std::ptrdiff_t>(tiles[0].blocks));
}

TEST_F(MapWindowTest, AFileThatIsNoMapIsRefused) {
  file_[1] = std::byte{0};
  EXPECT_THROW((void)assembler(10.0), std::runtime_error);
  file_.resize(20);
  EXPECT_THROW((void)assembler(10.0), std::runtime_error);
  file_.clear();
  EXPECT_THROW((void)assembler(10.0), std::runtime_error);
}

}  // namespace
}  // namespace landfix::ndt::test
