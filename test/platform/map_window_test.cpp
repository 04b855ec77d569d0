#include "platform/map_window.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ndt/map_layout.hpp"
#include "ndt/voxel_map_builder.hpp"
#include "ndt/voxel_moments.hpp"
#include "platform/atomic_file.hpp"
#include "platform/hand_over.hpp"
#include "platform/heap_counter.hpp"
#include "platform/map_aid_threads.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

TEST(HandOver, TheReaderHasAFinishedBufferAndTheWriterTheOtherOne) {
  HandOver hand_over;
  ASSERT_TRUE(hand_over.writable());
  const std::size_t first = *hand_over.writable();
  EXPECT_NE(hand_over.newest(), first) << "nothing is published yet";
  hand_over.publish();
  EXPECT_FALSE(hand_over.writable()) << "the reader may still read the other one";
  EXPECT_EQ(hand_over.newest(), first);
  EXPECT_EQ(hand_over.newest(), first);
  ASSERT_TRUE(hand_over.writable());
  EXPECT_NE(*hand_over.writable(), first);
  hand_over.publish();
  EXPECT_NE(hand_over.newest(), first);
}

/// In any order of steps the two never have the same buffer.
TEST(HandOver, InEveryOrderOfStepsEachHasItsOwnBuffer) {
  constexpr unsigned kSteps = 14;
  for (unsigned order = 0; order < (1U << kSteps); ++order) {
    HandOver hand_over;
    std::size_t reads = 1;
    unsigned published = 0;
    std::array<unsigned, 2> contents{};
    for (unsigned step = 0; step < kSteps; ++step) {
      if ((order >> step & 1U) == 0) {
        reads = hand_over.newest();
        ASSERT_EQ(contents[reads], published);
      } else if (const auto writes = hand_over.writable()) {
        ASSERT_NE(*writes, reads);
        contents[*writes] = ++published;
        hand_over.publish();
      }
    }
  }
}

TEST(HandOver, BetweenThreadsNoBufferIsReadWhileItIsWritten) {
  constexpr unsigned kWindows = 20000;
  HandOver hand_over;
  std::array<std::array<unsigned, 64>, 2> buffers{};
  std::jthread writer([&] {
    for (unsigned window = 1; window <= kWindows;) {
      const auto index = hand_over.writable();
      if (!index) {
        std::this_thread::yield();
        continue;
      }
      buffers[*index].fill(window++);
      hand_over.publish();
    }
  });
  unsigned last = 0;
  while (last < kWindows) {
    const auto& buffer = buffers[hand_over.newest()];
    ASSERT_GE(buffer.front(), last);
    ASSERT_LE(buffer.front(), last + 1) << "none is skipped: the writer waits for the reader";
    for (const unsigned value : buffer) ASSERT_EQ(value, buffer.front());
    last = buffer.front();
    std::this_thread::yield();
  }
}

/// A road of 1 km along x with walls, its map at 1 m.
class MapWindowTest : public testing::Test {
 protected:
  MapWindowTest() {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    ndt::VoxelMapBuilder builder(1.0, 100'000);
    for (int i = 0; i < 200'000; ++i) {
      const double x_m = 1000.0 * unit(random);
      builder.add({x_m, 10.0 * unit(random), 0.5 + 0.01 * unit(random)});
      builder.add({x_m, 10.5 + 0.01 * unit(random), 4.0 * unit(random)});
    }
    image_ = builder.build();
    AtomicFile file(path_);
    file.write(image_.bytes());
    file.commit();
  }

  [[nodiscard]] static bool has_road(const ndt::VoxelMap& map, double x_m) {
    return map.find_block(ndt::block_key(ndt::cell_of({x_m, 2.5, 0.5}))) != nullptr;
  }
  test::TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_.path() / "road.ndt";
  ndt::MapImage image_;
};

TEST_F(MapWindowTest, FollowsTheVehicleAndAlwaysReachesAsFarAsTheSensor) {
  MapWindow window(path_, {.memory_bytes = 1 << 20, .reach_m = 50.0}, Eigen::Vector3d(100.0, 5.0, 0.0));
  for (double x_m = 100.0; x_m < 900.0; x_m += 3.0) {
    const ndt::VoxelMap map = window.newest({x_m, 5.0, 0.0});
    for (double ahead_m = -50.0; ahead_m <= 50.0; ahead_m += 5.0) EXPECT_TRUE(has_road(map, x_m + ahead_m));
    EXPECT_FALSE(has_road(map, x_m + 250.0)) << "it is a window";
    (void)window.load();
  }
  EXPECT_GT(window.counters().windows, 15U);
  EXPECT_EQ(window.counters().tiles_not_fitting, 0U);
  EXPECT_EQ(window.counters().tiles_unreadable, 0U);
}

TEST_F(MapWindowTest, LoadsNothingWhileTheVehicleStaysOrTheSolverHasNotTakenTheLastWindow) {
  MapWindow window(path_, {.memory_bytes = 1 << 20, .reach_m = 50.0}, Eigen::Vector3d(100.0, 5.0, 0.0));
  (void)window.newest({105.0, 5.0, 0.0});
  EXPECT_FALSE(window.load());
  (void)window.newest({150.0, 5.0, 0.0});
  EXPECT_TRUE(window.load());
  EXPECT_FALSE(window.load());
  EXPECT_TRUE(has_road(window.newest({400.0, 5.0, 0.0}), 230.0)) << "the window around 150 m";
  EXPECT_TRUE(window.load()) << "a leap";
  EXPECT_TRUE(has_road(window.newest({400.0, 5.0, 0.0}), 400.0));
}

TEST_F(MapWindowTest, ItsHandOverAllocatesNothing) {
  if (!HeapCounter::available()) GTEST_SKIP() << "the heap cannot be counted here";
  MapWindow window(path_, {.memory_bytes = 1 << 20, .reach_m = 50.0}, Eigen::Vector3d(100.0, 5.0, 0.0));
  const std::uint64_t before = HeapCounter::calls();
  HeapCounter::arm();
  for (double x_m = 100.0; x_m < 900.0; x_m += 10.0) {
    (void)window.newest({x_m, 5.0, 0.0});
    (void)window.load();
  }
  HeapCounter::disarm();
  EXPECT_EQ(HeapCounter::calls(), before) << "the solver's part and the loader's";
  EXPECT_GT(window.counters().windows, 15U);
}

TEST_F(MapWindowTest, WithoutAPlaceBeginsInTheMiddle) {
  MapWindow window(path_, {.memory_bytes = 1 << 20, .reach_m = 50.0}, std::nullopt);
  EXPECT_NEAR(window.start_m().x(), 500.0, 20.0);
  EXPECT_TRUE(has_road(window.newest(window.start_m()), window.start_m().x()));
}

TEST_F(MapWindowTest, SaysHowManyTilesFoundNoRoom) {
  MapWindow window(path_, {.memory_bytes = 100'000, .reach_m = 50.0}, Eigen::Vector3d(500.0, 5.0, 0.0));
  EXPECT_GT(window.counters().tiles_not_fitting, 0U);
  EXPECT_TRUE(has_road(window.newest({500.0, 5.0, 0.0}), 500.0)) << "the nearest are there";
}

TEST_F(MapWindowTest, ATileDamagedOnDiskIsCountedAndTheRestGoesOn) {
  MapWindow window(path_, {.memory_bytes = 1 << 20, .reach_m = 50.0}, Eigen::Vector3d(100.0, 5.0, 0.0));
  {
    // In place, under the open file: half of the voxels.
    const ndt::MapLayout layout(ndt::VoxelMap(image_.bytes()).header());
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>((layout.voxels + layout.blocks) / 2));
    file << "damage";
  }
  std::size_t sweeps_with_road = 0;
  for (double x_m = 100.0; x_m < 900.0; x_m += 10.0) {
    if (has_road(window.newest({x_m, 5.0, 0.0}), x_m)) ++sweeps_with_road;
    (void)window.load();
  }
  EXPECT_GT(window.counters().tiles_unreadable, 0U);
  EXPECT_GE(sweeps_with_road, 80U - 5U);
}

TEST_F(MapWindowTest, ALoaderThreadKeepsUpWithASolverThatNeverWaits) {
  MapWindow window(path_, {.memory_bytes = 1 << 20, .reach_m = 50.0}, Eigen::Vector3d(100.0, 5.0, 0.0));
  const MapAidThreads loader({.window = &window});
  std::size_t voxels = 0;
  for (double x_m = 100.0; x_m < 900.0; x_m += 1.0) {
    const ndt::VoxelMap map = window.newest({x_m, 5.0, 0.0});
    ndt::visit_voxels(map, [&](const ndt::Voxel& voxel, const Eigen::Vector3d& /*mean_m*/) {
      ASSERT_GE(voxel.count, ndt::kMinVoxelPoints);
      ++voxels;
    });
    // The vehicle drives; how fast the loader gets its turn is the machine's affair.
    while (!has_road(map, x_m) && !has_road(window.newest({x_m, 5.0, 0.0}), x_m)) std::this_thread::yield();
  }
  EXPECT_GT(voxels, 0U);
  EXPECT_GT(window.counters().windows, 2U);
}

TEST_F(MapWindowTest, AFileThatIsNoMapOrIsNotThereIsRefused) {
  const auto error_of = [&](const std::filesystem::path& path) -> std::string {
    try {
      const MapWindow window(path, {.memory_bytes = 1 << 20}, Eigen::Vector3d::Zero());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_of(directory_.path() / "missing.ndt"), testing::HasSubstr("cannot open: No such file"));
  std::filesystem::resize_file(path_, 5000);
  EXPECT_THAT(error_of(path_), testing::HasSubstr("road.ndt: truncated: 5000 bytes"));
  std::ofstream(path_) << "# .PCD v0.7";
  EXPECT_THAT(error_of(path_), testing::HasSubstr("not a landfix map"));
}

}  // namespace
}  // namespace landfix::platform
