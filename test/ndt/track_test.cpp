#include "ndt/track.hpp"

#include <gtest/gtest.h>

namespace landfix::ndt::test {
namespace {

constexpr std::int64_t kSweep_ns = 100'000'000;
constexpr double kSpeed_mps = 12.0;

/// A vehicle that drives along x, and the matches of its sweeps.
class Drives : public testing::Test {
 protected:
  [[nodiscard]] static double truth_m(int sweep) { return 0.1 * kSpeed_mps * sweep; }
  [[nodiscard]] static MatchResult match_at(double x_m) {
    MatchResult match{.nearest_voxel_likelihood = 0.9,
                      .no_ground_nearest_voxel_likelihood = 0.9,
                      .points = 1000,
                      .points_matched = 1000,
                      .no_ground_points = 500,
                      .no_ground_points_matched = 500,
                      .converged = true};
    match.pose.translation().x() = x_m;
    match.covariance = 1e-4 * Matrix6::Identity();
    return match;
  }
  /// Where a sweep seems to be that was undistorted as if the vehicle drove at that speed.
  [[nodiscard]] static double seen_m(int sweep, double undistorted_mps) {
    return truth_m(sweep) - 0.05 * (kSpeed_mps - undistorted_mps);
  }
  [[nodiscard]] static Velocity along(double speed_mps) {
    Velocity velocity = Velocity::Zero();
    velocity[0] = speed_mps;
    return velocity;
  }
  void begin(double undistorted_mps) {
    track_.begin({0, match_at(seen_m(0, undistorted_mps)).pose}, 0.9, along(undistorted_mps),
                 along(undistorted_mps));
  }
  void follow(int sweep, double undistorted_mps, double off_m = 0.0) {
    const std::int64_t stamp_utc_ns = sweep * kSweep_ns;
    track_.follow(match_at(seen_m(sweep, undistorted_mps) + off_m),
                  {stamp_utc_ns, track_.expected_at(stamp_utc_ns)}, along(undistorted_mps), 0.5);
  }

  Track track_{FitGates{}};
};

TEST_F(Drives, LearnsTheVelocityThatItsSweepsWereNotUndistortedWith) {
  begin(0.0);
  for (int sweep = 1; sweep <= 6; ++sweep) {
    follow(sweep, 0.0);
    ASSERT_TRUE(track_.exists()) << sweep;
    EXPECT_NEAR(track_.velocity()[0], kSpeed_mps, 1e-6) << sweep;
    EXPECT_NEAR(track_.at().pose.translation().x(), truth_m(sweep), 1e-6) << sweep;
  }
  EXPECT_EQ(track_.agreeing(), 5);
}

TEST_F(Drives, IsNotDisturbedWhenTheRightVelocityIsUsed) {
  begin(0.0);
  for (int sweep = 1; sweep <= 6; ++sweep) {
    follow(sweep, sweep < 3 ? 0.0 : kSpeed_mps);
    ASSERT_TRUE(track_.exists()) << sweep;
    EXPECT_NEAR(track_.at().pose.translation().x(), truth_m(sweep), 1e-6) << sweep;
  }
}

TEST_F(Drives, IsDroppedWhereItLeaps) {
  begin(kSpeed_mps);
  follow(1, kSpeed_mps);
  follow(2, kSpeed_mps);
  EXPECT_EQ(track_.agreeing(), 1);
  follow(3, kSpeed_mps, 0.4);
  EXPECT_TRUE(track_.exists());
  EXPECT_EQ(track_.agreeing(), 0) << "near enough to be it, too far to agree";
  follow(4, kSpeed_mps, 2.0);
  EXPECT_FALSE(track_.exists());
}

TEST_F(Drives, IsDroppedAfterAGapAndSkipsASplinter) {
  begin(kSpeed_mps);
  EXPECT_TRUE(track_.is_splinter(kSweep_ns / 5));
  EXPECT_FALSE(track_.is_splinter(kSweep_ns));
  follow(6, kSpeed_mps);
  EXPECT_FALSE(track_.exists());
}

}  // namespace
}  // namespace landfix::ndt::test
