#include "ndt/reach.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "ndt/random_world.hpp"

namespace landfix::ndt::test {
namespace {

constexpr double kSlope = 0.08;

/// A hillside that rises along x, and above a part of it a bridge, level, 9 m over its foot.
std::vector<Eigen::Vector3d> hillside() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> side_m(-40.0, 40.0);
  std::vector<Eigen::Vector3d> points_m;
  for (int i = 0; i < 100'000; ++i) {
    const double x_m = side_m(random);
    points_m.emplace_back(x_m, side_m(random), kSlope * x_m);
    if (std::abs(x_m) < 5.0) points_m.emplace_back(x_m, side_m(random), 9.0);
  }
  return points_m;
}

class Ground : public testing::Test {
 protected:
  MapImage image_ = build_map(hillside(), 1.0);
  VoxelMap map_{image_.bytes()};
};

TEST_F(Ground, IsTheVoxelThatIsNearest) {
  EXPECT_NEAR(ground_m(map_, {10.5, 3.5, 0.0}, 2.0).value(), kSlope * 10.5, 0.05);
  EXPECT_NEAR(ground_m(map_, {0.5, 3.5, 1.0}, 20.0).value(), 0.0, 0.1);
  EXPECT_NEAR(ground_m(map_, {0.5, 3.5, 7.0}, 20.0).value(), 9.0, 0.05) << "the bridge";
  EXPECT_FALSE(ground_m(map_, {10.5, 3.5, 6.0}, 2.0)) << "too far up";
  EXPECT_FALSE(ground_m(map_, {50.5, 3.5, 4.0}, 2.0)) << "beyond the map";
  EXPECT_FALSE(ground_m(map_, {1e12, 3.5, 4.0}, 2.0)) << "beyond every map";
}

TEST_F(Ground, TheLowestIsBelowTheBridge) {
  EXPECT_NEAR(lowest_m(map_, {2.0, 0.0}, 3.0).value(), 0.0, 0.6);
  EXPECT_FALSE(lowest_m(map_, {200.0, 0.0}, 3.0));
}

TEST_F(Ground, ABridgeIsASecondFloor) {
  std::array<double, 4> heights_m{};
  ASSERT_EQ(find_floors(map_, {0.5, 3.5}, -1.0, heights_m), 2U);
  EXPECT_NEAR(heights_m[0], 0.0, 0.1);
  EXPECT_NEAR(heights_m[1], 9.0, 0.05);
  ASSERT_EQ(find_floors(map_, {10.5, 3.5}, -1.0, heights_m), 1U);
  EXPECT_NEAR(heights_m[0], kSlope * 10.5, 0.05);
  ASSERT_EQ(find_floors(map_, {0.5, 3.5}, -1.0, std::span(heights_m).first(1)), 1U);
  EXPECT_NEAR(heights_m[0], 0.0, 0.1) << "the lowest stays";
  EXPECT_EQ(find_floors(map_, {50.5, 3.5}, -1.0, heights_m), 0U) << "beyond the map";
  EXPECT_EQ(find_floors(map_, {1e12, 3.5}, -1.0, heights_m), 0U) << "beyond every map";
}

TEST_F(Ground, APoseOnASlopeLeansWithIt) {
  const Pose uphill = on_slope(map_, make_pose({20.0, 0.0, kSlope * 20.0}, {}));
  EXPECT_NEAR(to_roll_pitch_yaw(uphill.linear()).pitch_rad, -std::atan(kSlope), 0.01) << "nose up";
  EXPECT_NEAR(to_roll_pitch_yaw(uphill.linear()).roll_rad, 0.0, 0.01);
  const Pose across =
      on_slope(map_, make_pose({20.0, 0.0, kSlope * 20.0}, {.yaw_rad = std::numbers::pi / 2.0}));
  EXPECT_NEAR(to_roll_pitch_yaw(across.linear()).pitch_rad, 0.0, 0.01);
  EXPECT_NEAR(to_roll_pitch_yaw(across.linear()).roll_rad, -std::atan(kSlope), 0.01) << "its right is uphill";
  const Pose away = make_pose({200.0, 0.0, 0.0}, {.yaw_rad = 1.0});
  EXPECT_TRUE(on_slope(map_, away).isApprox(away, 1e-12));
}

TEST(GuessSequence, FillsACircleAndItsHeadings) {
  GuessSequence sequence;
  std::array<int, 8> sectors{};
  for (int i = 0; i < 800; ++i) {
    const Eigen::Vector3d way = sequence.next_around(3.0, 0.1);
    EXPECT_LE(way.head<2>().norm(), 3.0);
    EXPECT_LE(std::abs(way.z()), 0.1);
    const double turn = (std::atan2(way.y(), way.x()) + std::numbers::pi) / (2.0 * std::numbers::pi);
    ++sectors[static_cast<std::size_t>(turn * 8.0) % 8];
  }
  for (const int count : sectors) EXPECT_NEAR(count, 100, 10);
}

TEST(GuessSequence, NoWayIsLongerThanTheReach) {
  GuessSequence sequence;
  int ahead = 0;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d way = sequence.next_on_way(30.0);
    EXPECT_LE(way.head<2>().norm(), 30.0 + 1e-9);
    ahead += way.x() > 0.0 ? 1 : 0;
  }
  EXPECT_GT(ahead, 600) << "vehicles mostly go on";
}

TEST(Reach, GrowsWithTimeUpToALimit) {
  EXPECT_DOUBLE_EQ(reach_m(10.0, 0.0), 3.0);
  EXPECT_DOUBLE_EQ(reach_m(10.0, 2.0), 26.0);
  EXPECT_DOUBLE_EQ(reach_m(-10.0, 2.0), 26.0);
  EXPECT_DOUBLE_EQ(reach_m(10.0, 1e9), 150.0);
  EXPECT_DOUBLE_EQ(reach_m(10.0, -1.0), 3.0);
}

}  // namespace
}  // namespace landfix::ndt::test
