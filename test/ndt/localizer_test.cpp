#include "ndt/localizer.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "ndt/covariance.hpp"
#include "ndt/degenerate_world.hpp"
#include "ndt/random_world.hpp"

namespace landfix::ndt::test {
namespace {

constexpr std::int64_t kSweep_ns = 100'000'000;

/// A yard, and a vehicle that drives through it at 4 m/s in a gentle curve.
class Drive : public ::testing::Test {
 protected:
  [[nodiscard]] Pose truth(int sweep) const { return start_ * pose_exp(velocity_ * (0.1 * sweep)); }

  [[nodiscard]] std::vector<Eigen::Vector3f> scan(int sweep) const {
    std::vector<Eigen::Vector3d> cloud = random_yard(1, 41200);
    cloud.erase(cloud.begin(), cloud.end() - 1200);
    return seen_from(cloud, truth(sweep));
  }
  [[nodiscard]] Fix localize(int sweep) { return localizer_.localize(scan(sweep), kSweep_ns * (10 + sweep)); }
  [[nodiscard]] Fix see_nothing(int sweep) { return localizer_.localize({}, kSweep_ns * (10 + sweep)); }
  [[nodiscard]] double error_m(const Fix& fix, int sweep) const {
    return (fix.at.pose.translation() - truth(sweep).translation()).norm();
  }

  Velocity velocity_ = (Velocity() << 4.0, 0.0, 0.0, 0.0, 0.0, 0.2).finished();
  Pose start_ = make_pose({-6.0, 0.0, 0.5}, {.yaw_rad = -0.1});
  MapImage image_ = build_map(random_yard(1, 40000), 1.0);
  VoxelMap map_{image_.bytes()};
  Localizer localizer_{map_, {}, start_* make_pose({0.2, -0.1, 0.05}, {.yaw_rad = 0.02})};
};

TEST_F(Drive, TracksOnceItsSweepsAreUndistortedWithItsVelocity) {
  for (int sweep = 0; sweep < 20; ++sweep) {
    const Fix fix = localize(sweep);
    EXPECT_EQ(fix.state, sweep < 2 ? State::degraded : State::tracking) << sweep;
    EXPECT_LT(error_m(fix, sweep), 0.05) << sweep;
    EXPECT_EQ(fix.at.stamp_utc_ns, kSweep_ns * (10 + sweep));
  }
  EXPECT_NEAR(localizer_.velocity()[0], 4.0, 0.4);
  EXPECT_NEAR(localizer_.velocity()[5], 0.2, 0.1);
}

TEST_F(Drive, PredictsWhileItSeesNothingAndTracksAgain) {
  for (int sweep = 0; sweep < 5; ++sweep) (void)localize(sweep);
  for (int sweep = 5; sweep < 10; ++sweep) {
    const Fix fix = see_nothing(sweep);
    EXPECT_EQ(fix.state, State::predicted);
    EXPECT_LT(error_m(fix, sweep), 0.3) << sweep;
  }
  const Fix fix = localize(10);
  EXPECT_EQ(fix.state, State::tracking);
  EXPECT_LT(error_m(fix, 10), 0.05);
}

TEST_F(Drive, IsLostAfterASecondOfPrediction) {
  for (int sweep = 0; sweep < 5; ++sweep) (void)localize(sweep);
  State last = State::tracking;
  for (int sweep = 5; sweep < 20; ++sweep) last = see_nothing(sweep).state;
  EXPECT_EQ(last, State::lost);
  EXPECT_FALSE(is_usable(last));
}

TEST_F(Drive, PredictsMissingSweepsAndForgetsThemWhenTheyComeAfterAll) {
  for (int sweep = 0; sweep < 5; ++sweep) (void)localize(sweep);
  const Pose before = localizer_.pose();
  double sigma_before_m = 0.0;
  for (int sweep = 5; sweep < 15; ++sweep) {
    const Fix fix = localizer_.predict_missing(kSweep_ns * (10 + sweep));
    EXPECT_EQ(fix.state, sweep <= 14 ? State::predicted : State::lost) << sweep;
    EXPECT_LT(error_m(fix, sweep), 0.06 * (sweep - 3)) << sweep;
    EXPECT_NEAR(fix.velocity[0], 4.0, 0.4);
    EXPECT_GT(std::sqrt(fix.covariance(0, 0)), sigma_before_m);
    sigma_before_m = std::sqrt(fix.covariance(0, 0));
  }
  EXPECT_EQ(localizer_.predict_missing(kSweep_ns * 25).state, State::lost);
  EXPECT_EQ(localizer_.pose().matrix(), before.matrix());
  EXPECT_EQ(localize(5).state, State::tracking);
}

TEST_F(Drive, AfterASilenceLooksWhereTheMotionHadLed) {
  for (int sweep = 0; sweep < 5; ++sweep) (void)localize(sweep);
  for (int sweep = 15; sweep < 40; sweep += 5) {
    const Fix silent = localizer_.wait_for_data(kSweep_ns * (10 + sweep));
    EXPECT_EQ(silent.state, State::no_data);
    EXPECT_EQ(silent.at.stamp_utc_ns, kSweep_ns * (10 + sweep));
    EXPECT_LT(error_m(silent, 14), 0.6) << "a second of motion, not more";
  }
  // The vehicle stopped where it was a second after the last sweep.
  for (int sweep = 47; sweep < 51; ++sweep)
    EXPECT_EQ(localizer_.localize(scan(14), kSweep_ns * sweep).state, State::lost) << "not confirmed yet";
  const Fix fix = localizer_.localize(scan(14), kSweep_ns * 51);
  EXPECT_EQ(fix.state, State::tracking);
  EXPECT_LT(error_m(fix, 14), 0.05);
}

TEST_F(Drive, ASilenceBeforeTheFirstMatchLeavesTheGuess) {
  EXPECT_EQ(see_nothing(0).state, State::init);
  EXPECT_EQ(localizer_.predict_missing(kSweep_ns * 11).state, State::init);
  EXPECT_EQ(localizer_.wait_for_data(kSweep_ns * 21).state, State::no_data);
  EXPECT_EQ(see_nothing(12).state, State::init);
  EXPECT_EQ(localizer_.localize(scan(0), kSweep_ns * 23).state, State::degraded)
      << "its velocity is not known";
}

TEST_F(Drive, GoesOnAsBeforeWhereTheClockIsSetWhileSweepsCome) {
  for (int sweep = 0; sweep < 5; ++sweep)
    (void)localizer_.localize(scan(sweep), kSweep_ns * (100'000 + sweep));
  for (int sweep = 5; sweep < 15; ++sweep) {
    const std::int64_t leap = sweep < 10 ? 1'000'000 : -90'000;
    const Fix fix = localizer_.localize(scan(sweep), kSweep_ns * (100'000 + leap + sweep));
    EXPECT_EQ(fix.state, State::tracking) << sweep;
    EXPECT_LT(error_m(fix, sweep), 0.05) << sweep;
    EXPECT_NEAR(localizer_.velocity()[0], 4.0, 0.4);
  }
}

TEST_F(Drive, MayBecomeLostWhereTheClockIsSetBack) {
  for (int sweep = 0; sweep < 5; ++sweep) (void)localizer_.localize(scan(sweep), kSweep_ns * (1000 + sweep));
  State last = see_nothing(0).state;
  EXPECT_EQ(last, State::predicted);
  for (int sweep = 1; sweep < 13; ++sweep) last = see_nothing(sweep).state;
  EXPECT_EQ(last, State::lost);
}

TEST_F(Drive, WithoutAPoseIsFoundNearAGuess) {
  Localizer localizer(map_, {}, std::nullopt);
  EXPECT_EQ(localizer.localize(scan(0), kSweep_ns * 10).state, State::init) << "no guess, no search";
  int searched = 0;
  for (int sweep = 1; sweep < 25; ++sweep) {
    const Pose there = truth(sweep);
    localizer.expect_near(PoseGuess{.position_m = there.translation().head<2>() + Eigen::Vector2d(1.5, -1.0),
                                    .yaw_rad = to_roll_pitch_yaw(there.linear()).yaw_rad + 0.05});
    const Fix fix = localizer.localize(scan(sweep), kSweep_ns * (10 + sweep));
    if (fix.state == State::init) {
      EXPECT_FALSE(is_usable(fix.state));
      ++searched;
      continue;
    }
    EXPECT_EQ(fix.state, State::tracking) << sweep;
    EXPECT_LT(error_m(fix, sweep), 0.05) << sweep;
  }
  EXPECT_LT(searched, 12);
  EXPECT_GE(searched, 4) << "it has to be confirmed";
}

TEST_F(Drive, APoseThatIsWrongGivesWayToAGuess) {
  Localizer localizer(map_, {}, start_ * make_pose({8.0, 5.0, 0.0}, {.yaw_rad = 1.5}));
  State last = State::init;
  for (int sweep = 0; sweep < 25; ++sweep) {
    localizer.expect_near(PoseGuess{.position_m = truth(sweep).translation().head<2>()});
    const Fix fix = localizer.localize(scan(sweep), kSweep_ns * (10 + sweep));
    last = fix.state;
    if (last == State::tracking) {
      EXPECT_LT(error_m(fix, sweep), 0.05) << sweep;
    }
  }
  EXPECT_EQ(last, State::tracking);
}

TEST_F(Drive, IsFoundAgainWhereItHasDrivenUnseen) {
  for (int sweep = 0; sweep < 5; ++sweep) (void)localize(sweep);
  (void)localizer_.wait_for_data(kSweep_ns * 25);
  int lost = 0;
  for (int sweep = 25; sweep < 40; ++sweep) {
    const Fix fix = localize(sweep);
    if (fix.state != State::tracking) {
      EXPECT_EQ(fix.state, State::lost);
      ++lost;
      continue;
    }
    EXPECT_LT(error_m(fix, sweep), 0.05) << sweep;
  }
  EXPECT_LE(lost, 8);
}

TEST_F(Drive, IsNotLedAwayByASplinterOfASweep) {
  for (int sweep = 0; sweep < 5; ++sweep) (void)localize(sweep);
  std::vector<Eigen::Vector3f> splinter = scan(4);
  splinter.resize(100);
  for (Eigen::Vector3f& point : splinter) point.x() += 0.4F;
  const Fix of_splinter = localizer_.localize(splinter, kSweep_ns * 14 + 887'000);
  EXPECT_LT(error_m(of_splinter, 4), 0.15);
  EXPECT_NEAR(localizer_.velocity()[0], 4.0, 0.4);
  const Fix fix = localize(5);
  EXPECT_EQ(fix.state, State::tracking);
  EXPECT_LT(error_m(fix, 5), 0.05);
}

TEST_F(Drive, StaysInInitUntilAMatchIsBelieved) {
  EXPECT_EQ(see_nothing(0).state, State::init);
  EXPECT_EQ(see_nothing(1).state, State::init);
  EXPECT_EQ(localizer_.localize(scan(0), kSweep_ns * 12).state, State::degraded)
      << "its velocity is not known";
}

TEST_F(Drive, WantsASearchUntilItIsSureAndWhenItIsNotAnyMore) {
  EXPECT_TRUE(localizer_.wants_search());
  for (int sweep = 0; sweep < 5; ++sweep) (void)localize(sweep);
  EXPECT_FALSE(localizer_.wants_search());
  for (int sweep = 5; sweep < 7; ++sweep) {
    (void)see_nothing(sweep);
    EXPECT_FALSE(localizer_.wants_search()) << sweep;
  }
  for (int sweep = 7; sweep < 9; ++sweep) (void)see_nothing(sweep);
  EXPECT_TRUE(localizer_.wants_search());
  EXPECT_EQ(localize(9).state, State::tracking);
  EXPECT_FALSE(localizer_.wants_search());
}

TEST_F(Drive, GoesWhereItIsFoundFromAWrongPoseOrHeading) {
  for (const Pose& wrong :
       {start_ * make_pose({8.0, 5.0, 0.0}, {}), start_ * make_pose({}, {.yaw_rad = 2.5})}) {
    Localizer localizer(map_, {}, wrong);
    for (int sweep = 0; sweep < 8; ++sweep) {
      if (sweep >= 5) {
        localizer.expect_found(
            Found{.at = {kSweep_ns * (9 + sweep), truth(sweep - 1)}, .velocity = velocity_});
      }
      const Fix fix = localizer.localize(scan(sweep), kSweep_ns * (10 + sweep));
      EXPECT_EQ(fix.state == State::tracking, sweep > 5) << "once it is undistorted with the velocity found";
      if (fix.state != State::tracking) continue;
      EXPECT_LT(error_m(fix, sweep), 0.05);
    }
  }
}

TEST_F(Drive, HeedsNoAnswerOfAnotherTime) {
  for (const std::int64_t age_ns : {-kSweep_ns, std::int64_t{0}, 10 * kSweep_ns}) {
    Localizer localizer(map_, {}, start_);
    for (int sweep = 0; sweep < 5; ++sweep) (void)localizer.localize(scan(sweep), kSweep_ns * (10 + sweep));
    for (int sweep = 5; sweep < 9; ++sweep) (void)localizer.localize({}, kSweep_ns * (10 + sweep));
    const std::int64_t stamp_utc_ns = kSweep_ns * 19;
    localizer.expect_found(Found{.at = {stamp_utc_ns - age_ns, Pose::Identity()}});
    EXPECT_EQ(localizer.localize(scan(9), stamp_utc_ns).state, State::tracking) << age_ns;
  }
}

TEST_F(Drive, DoesNotBelieveALeap) {
  LocalizerSettings strict;
  strict.innovation_limit_m = 0.5;
  Localizer localizer(map_, strict, start_);
  for (int sweep = 0; sweep < 5; ++sweep) (void)localizer.localize(scan(sweep), kSweep_ns * (10 + sweep));
  // The same yard seen from 0.7 m aside: a good match, but no vehicle moves so.
  std::vector<Eigen::Vector3f> moved = scan(5);
  for (Eigen::Vector3f& point : moved) point.y() += 0.7F;
  const Fix fix = localizer.localize(moved, kSweep_ns * 15);
  EXPECT_NE(judge(fix.match, {}), Fit::none);
  EXPECT_GT((fix.match.pose.translation() - truth(5).translation()).norm(), 0.5);
  EXPECT_EQ(fix.state, State::predicted);
  EXPECT_LT(error_m(fix, 5), 0.1);
}

TEST(Localizer, GoesOnAsBeforeAlongACorridorAndSaysSo) {
  const std::vector<Eigen::Vector2d> places{{-8.0, 2.0}, {-4.5, -2.5}, {-1.0, 3.0}, {2.0, -1.0}};
  const MapImage image = build_map(joined(corridor(1, 120000, -25.0, 60.0), pillars(2, 4000, places)), 1.0);
  const VoxelMap map(image.bytes());
  const auto world = joined(corridor(3, 6000, -25.0, 60.0), pillars(4, 200, places));
  const auto truth_m = [](int sweep) { return -5.0 + 0.4 * sweep; };
  Localizer localizer(map, {}, make_pose({-5.0, 0.0, 0.0}, {}));
  double before_m = 0.0;
  double sigma_before_m = 0.0;
  for (int sweep = 0; sweep < 90; ++sweep) {
    std::vector<Eigen::Vector3d> near;
    for (const Eigen::Vector3d& point_m : world) {
      if (std::abs(point_m.x() - truth_m(sweep)) < 12.0) near.push_back(point_m);
    }
    const Fix fix =
        localizer.localize(seen_from(near, make_pose({truth_m(sweep), 0.0, 0.0}, {})), kSweep_ns * sweep);
    const Eigen::Vector3d place_m = fix.at.pose.translation();
    EXPECT_NEAR(place_m.y(), 0.0, 0.05) << sweep;
    const double sigma_m = std::sqrt(to_vehicle_covariance(fix.covariance, fix.at.pose)(0, 0));
    if (sweep < 20) {
      EXPECT_EQ(fix.state, sweep < 2 ? State::degraded : State::tracking) << sweep;
    } else if (sweep > 50) {
      // 12 m and more behind the last pillar.
      EXPECT_EQ(fix.state, State::degraded) << sweep;
      ASSERT_EQ(fix.match.weak.count, 1U) << sweep;
      EXPECT_EQ(fix.match.weak.at[0].axis, Axis::longitudinal);
      EXPECT_NEAR(place_m.x() - before_m, 0.4, 0.02) << sweep;
      EXPECT_GT(sigma_m, sigma_before_m) << sweep;
      EXPECT_LT(std::abs(place_m.x() - truth_m(sweep)), 3.0 * sigma_m + 0.05) << sweep;
    }
    before_m = place_m.x();
    sigma_before_m = sigma_m;
  }
}

}  // namespace
}  // namespace landfix::ndt::test
