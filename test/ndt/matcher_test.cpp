#include "ndt/matcher.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "ndt/objective.hpp"
#include "ndt/pair_groups.hpp"
#include "ndt/random_world.hpp"
#include "ndt/reference_matcher.hpp"
#include "ndt/simd_targets.hpp"

namespace landfix::ndt::test {
namespace {

constexpr double kResolution_m = 1.0;
const ScoreConstants kConstants = magnusson_constants(0.55, kResolution_m);

/// A scan of a yard, thinned so that the brute-force reference stays quick.
struct Yard {
  explicit Yard(std::uint64_t seed, const Eigen::Vector3d& origin_m = Eigen::Vector3d::Zero())
      : image(build_map(random_yard(seed, 40000, 0.02, origin_m), kResolution_m)), map(image.bytes()) {
    std::mt19937_64 random(seed + 1000);
    truth = random_pose(random, 1.0, 0.5);
    truth.translation() += origin_m;
    // Other points of the same world: the same seed draws the same walls, more points draw other samples.
    std::vector<Eigen::Vector3d> cloud = random_yard(seed, 41200, 0.02, origin_m);
    cloud.erase(cloud.begin(), cloud.end() - 1200);
    scan = in_spatial_order(seen_from(cloud, truth));
  }
  MapImage image;
  VoxelMap map;
  Pose truth;
  std::vector<Eigen::Vector3f> scan;
};

/// The objective of a scan whose pairs have just been looked up.
Objective evaluate_scan(const VoxelMap& map, std::span<const Eigen::Vector3f> scan, const Pose& pose,
                        Covariance covariance) {
  PairGroups groups(scan.size());
  groups.assign(scan);
  const Objective objective = evaluate(map, groups, pose, covariance, kConstants);
  EXPECT_EQ(groups.dropped_pairs(), 0U);
  return objective;
}

TEST(ReferenceMatcher, GradientAndHessianAgreeWithCentralDifferences) {
  std::mt19937_64 random(7);
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Yard yard(seed);
    for (const Covariance covariance : {Covariance::wide, Covariance::sharp}) {
      const auto voxels = reference_voxels(yard.map, covariance);
      const Pose pose = yard.truth * random_pose(random, 0.5, 0.05);
      const auto pairs = find_pairs(voxels, yard.scan, pose, kResolution_m);
      ASSERT_GT(pairs.size(), 500U);
      const auto score_at = [&](const Twist& step) {
        return evaluate_pairs(voxels, yard.scan, pairs, perturbed(pose, step), kConstants).score;
      };
      const ReferenceObjective exact = evaluate_pairs(voxels, yard.scan, pairs, pose, kConstants);
      // Rotation moves points by up to 20 m times the angle: its steps are smaller by that.
      Twist h = Twist::Constant(2e-5);
      h.tail<3>() /= 20.0;
      for (int i = 0; i < 6; ++i) {
        const Twist step_i = h[i] * Twist::Unit(i);
        const double slope = (score_at(step_i) - score_at(-step_i)) / (2.0 * h[i]);
        EXPECT_NEAR(exact.gradient[i], slope, 1e-6 * exact.absolute_gradient[i]) << i;
      }
      const auto bend_over = [&](const Twist& step_i, const Twist& step_j) {
        return (score_at(step_i + step_j) - score_at(step_i - step_j) - score_at(step_j - step_i) +
                score_at(-step_i - step_j)) /
               (4.0 * step_i.norm() * step_j.norm());
      };
      h.head<3>().setConstant(6e-5);
      h.tail<3>().setConstant(1.2e-5);
      for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
          const Twist step_i = h[i] * Twist::Unit(i);
          const Twist step_j = h[j] * Twist::Unit(j);
          // Richardson: the two step lengths cancel the error of second order.
          const double bend = (4.0 * bend_over(step_i, step_j) - bend_over(2.0 * step_i, 2.0 * step_j)) / 3.0;
          const double scale = std::sqrt(exact.absolute_hessian(i, i) * exact.absolute_hessian(j, j));
          EXPECT_NEAR(exact.hessian(i, j), bend, 1e-6 * scale) << i << ' ' << j;
        }
      }
    }
  }
}

TEST(Objective, AgreesWithTheReference) {
  std::mt19937_64 random(8);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Yard yard(seed);
    for (const Covariance covariance : {Covariance::wide, Covariance::sharp}) {
      const auto voxels = reference_voxels(yard.map, covariance);
      const Pose pose = yard.truth * random_pose(random, 1.0, 0.1);
      const auto pairs = find_pairs(voxels, yard.scan, pose, kResolution_m);
      const ReferenceObjective exact = evaluate_pairs(voxels, yard.scan, pairs, pose, kConstants);
      const Objective fast = evaluate_scan(yard.map, yard.scan, pose, covariance);
      EXPECT_EQ(fast.pairs, pairs.size());
      EXPECT_NEAR(fast.score, exact.score, 1e-5 * exact.absolute_score);
      const Matrix6 hessian = fast.curvature - fast.definite;
      const Matrix6 exact_hessian = exact.hessian - exact.second_order_rotation;
      for (int i = 0; i < 6; ++i) {
        EXPECT_NEAR(fast.gradient[i], exact.gradient[i], 1e-5 * exact.absolute_gradient[i]) << i;
        for (int j = 0; j < 6; ++j) {
          EXPECT_NEAR(hessian(i, j), exact_hessian(i, j), 1e-5 * exact.absolute_hessian(i, j))
              << i << ' ' << j;
        }
      }
    }
  }
}

TEST(Objective, PairsEveryVoxelWhoseMeanIsWithinOneResolution) {
  std::mt19937_64 random(9);
  for (const double resolution_m : {0.5, 1.0, 2.0}) {
    const auto cloud = random_yard(3, 60000, 0.3);
    const MapImage image = build_map(cloud, resolution_m);
    const VoxelMap map(image.bytes());
    const auto voxels = reference_voxels(map, Covariance::wide);
    ASSERT_EQ(voxels.size(), map.voxels().size());
    std::vector<Eigen::Vector3d> few(cloud.begin(), cloud.begin() + 500);
    const Pose pose = random_pose(random, 2.0, 3.0);
    const auto scan = seen_from(few, pose);
    EXPECT_EQ(evaluate_scan(map, scan, pose, Covariance::wide).pairs,
              find_pairs(voxels, scan, pose, resolution_m).size());
  }
}

void expect_same(const Objective& a, const Objective& b, double share) {
  EXPECT_EQ(a.pairs, b.pairs);
  EXPECT_NEAR(a.score, b.score, share * b.score);
  // Definite sums, so that each one is its own scale.
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double scale = std::sqrt(b.definite(i, i) * b.definite(j, j));
      EXPECT_NEAR(a.definite(i, j), b.definite(i, j), share * scale) << i << ' ' << j;
      EXPECT_NEAR(a.curvature(i, j), b.curvature(i, j), share * scale) << i << ' ' << j;
    }
    EXPECT_NEAR(a.gradient[i], b.gradient[i], share * std::sqrt(b.definite(i, i) * b.score)) << i;
  }
}

TEST(PairGroups, WhatIsRememberedEqualsWhatIsLookedUpAnew) {
  const Yard yard(3);
  std::mt19937_64 random(16);
  PairGroups groups(yard.scan.size());
  groups.assign(yard.scan);
  for (int i = 0; i < 30; ++i) {
    // Within the margin, beyond it for points that are far away, beyond it for all.
    const Pose pose = yard.truth * random_pose(random, i < 20 ? 0.1 : 1.0, i < 10 ? 0.001 : 0.05);
    const Covariance covariance = i % 3 == 0 ? Covariance::sharp : Covariance::wide;
    expect_same(evaluate(yard.map, groups, pose, covariance, kConstants),
                evaluate_scan(yard.map, yard.scan, pose, covariance), 1e-5);
  }
}

TEST(PairGroups, TakeAsManyPointsAsTheyHaveRoomFor) {
  const Yard yard(3);
  const std::span<const Eigen::Vector3f> scan(yard.scan);
  PairGroups small(300);
  small.assign(scan);
  expect_same(evaluate(yard.map, small, yard.truth, Covariance::wide, kConstants),
              evaluate_scan(yard.map, scan.first(300), yard.truth, Covariance::wide), 1e-5);
}

TEST(PairGroups, TakeSomePointsFromAllOverAScanWhateverPatternItHas) {
  std::vector<Eigen::Vector3f> scan;
  for (int i = 0; i < 2400; ++i) scan.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
  PairGroups groups(scan.size());
  groups.assign(scan, 400);
  std::vector<int> taken;
  for (std::size_t i = 0; i < groups.groups().size(); ++i) {
    for (const Eigen::Vector3f& point_m : groups.points_m(i)) {
      taken.push_back(
          static_cast<int>(std::lround(static_cast<double>(point_m.x()) + groups.groups()[i].centre_m.x())));
    }
  }
  ASSERT_EQ(taken.size(), 400U);
  for (int n = 0; n < 400; ++n) EXPECT_EQ(taken[static_cast<std::size_t>(n)] / 6, n);
  for (const int period : {2, 3, 4, 6, 8}) {
    for (int phase = 0; phase < period; ++phase) {
      const auto count =
          std::count_if(taken.begin(), taken.end(), [&](int index) { return index % period == phase; });
      EXPECT_NEAR(static_cast<double>(count), 400.0 / period, 10.0) << period;
    }
  }
}

TEST(PairGroups, HaveRoomForTheCandidatesOfAMapThatIsFullOfVoxels) {
  std::mt19937_64 random(19);
  std::uniform_real_distribution<double> coordinate_m(0.0, 8.0);
  std::vector<Eigen::Vector3d> cloud(8 * 8 * 8 * 50);
  for (Eigen::Vector3d& point_m : cloud)
    point_m = {coordinate_m(random), coordinate_m(random), coordinate_m(random)};
  const MapImage image = build_map(cloud, kResolution_m);
  const VoxelMap map(image.bytes());
  ASSERT_EQ(map.voxels().size(), 512U);
  const std::vector<Eigen::Vector3f> scan(200, {4.0F, 4.0F, 4.0F});
  for (const Reach& reach : {Reach{}, Reach{.pair = 1.5, .margin = 0.4}}) {
    PairGroups groups(scan.size(), reach);
    groups.assign(scan);
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < groups.groups().size(); ++i) {
      groups.update(map, Pose::Identity(), Covariance::wide, i);
      pairs += groups.groups()[i].pair_count;
    }
    EXPECT_GT(pairs, 5 * scan.size());
    EXPECT_EQ(groups.dropped_pairs(), 0U) << reach.pair;
  }
}

TEST(PairKernel, EveryInstructionSetGivesTheSame) {
  std::mt19937_64 random(17);
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Yard yard(seed);
    for (const Covariance covariance : {Covariance::wide, Covariance::sharp}) {
      const Pose pose = yard.truth * random_pose(random, 1.0, 0.1);
      const auto voxels = reference_voxels(yard.map, covariance);
      const auto pairs = find_pairs(voxels, yard.scan, pose, kResolution_m);
      const ReferenceObjective scale = evaluate_pairs(voxels, yard.scan, pairs, pose, kConstants);
      const Objective best = evaluate_scan(yard.map, yard.scan, pose, covariance);
      for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        const Objective other = evaluate_scan(yard.map, yard.scan, pose, covariance);
        EXPECT_EQ(other.pairs, best.pairs);
        EXPECT_NEAR(other.score, best.score, 1e-5 * scale.absolute_score);
        const Matrix6 difference = (other.definite - other.curvature) - (best.definite - best.curvature);
        for (int row = 0; row < 6; ++row) {
          EXPECT_NEAR(other.gradient[row], best.gradient[row], 1e-5 * scale.absolute_gradient[row]);
          for (int column = 0; column < 6; ++column) {
            EXPECT_NEAR(difference(row, column), 0.0, 1e-5 * scale.absolute_hessian(row, column))
                << hwy::TargetName(target) << ' ' << row << ' ' << column;
          }
        }
        ++compared;
      }
      hwy::SetSupportedTargetsForTest(0);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    }
  }
  EXPECT_GE(compared, 16 * (HWY_ARCH_ARM ? 1U : 2U));  // 64-bit Arm has but one
}

TEST(PairKernel, ComputesInVectorsOfTheProcessor) {
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();  // the best one first
  ASSERT_FALSE(targets.empty());
  EXPECT_EQ(targets.front() & (HWY_SCALAR | HWY_EMU128), 0) << hwy::TargetName(targets.front());
#if HWY_ARCH_ARM
  EXPECT_EQ(targets, std::vector<std::int64_t>{HWY_NEON});
#endif
}

TEST(Matcher, FindsTheOptimumOfTheReference) {
  std::mt19937_64 random(10);
  MatcherSettings precise;
  precise.converged_m = 1e-6;
  precise.converged_rad = 1e-7;
  precise.max_iterations = 200;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Yard yard(seed);
    const Pose guess = yard.truth * random_pose(random, 0.3, 0.02);
    const MatchResult fast = Matcher(precise).match(yard.map, yard.scan, guess);
    ASSERT_TRUE(fast.converged) << seed << " " << fast.iterations;
    ASSERT_TRUE(fast.sharpened);
    const Pose wide =
        match(reference_voxels(yard.map, Covariance::wide), yard.scan, guess, kResolution_m, kConstants);
    const Pose exact =
        match(reference_voxels(yard.map, Covariance::sharp), yard.scan, wide, kResolution_m, kConstants);
    // Not to the last digit: pairs come and go with the pose, so the score has steps, and more than one peak.
    EXPECT_LT((fast.pose.translation() - exact.translation()).norm(), 4e-3) << seed;
    EXPECT_LT(angle_between(fast.pose, exact), 4e-4) << seed;
  }
}

TEST(Matcher, FindsTheTruthFromNearby) {
  std::mt19937_64 random(11);
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Yard yard(seed);
    const MatchResult result =
        Matcher({}).match(yard.map, yard.scan, yard.truth * random_pose(random, 0.4, 0.03));
    EXPECT_TRUE(result.converged);
    EXPECT_LT((result.pose.translation() - yard.truth.translation()).norm(), 0.03) << seed;
    EXPECT_LT(angle_between(result.pose, yard.truth), 0.005) << seed;
    EXPECT_GT(result.nearest_voxel_likelihood, 0.6 * kConstants.d1);
  }
}

TEST(Matcher, NeverLowersTheScoreOfTheGuess) {
  // The coarse search climbs another score, with wider distributions.
  std::mt19937_64 random(12);
  MatcherSettings settings;
  settings.sharpen = false;
  settings.few_points = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Yard yard(seed);
    for (int start = 0; start < 20; ++start) {
      const Pose guess = yard.truth * random_pose(random, 5.0, 1.0);
      const double before = evaluate_scan(yard.map, yard.scan, guess, Covariance::wide).score;
      const MatchResult result = Matcher(settings).match(yard.map, yard.scan, guess);
      EXPECT_GE(result.score, before);
      EXPECT_LE(result.iterations, settings.max_iterations);
      EXPECT_TRUE(result.pose.matrix().allFinite());
    }
  }
}

TEST(Matcher, FindsTheTruthFromFartherAwayWithTheCoarseSearch) {
  std::mt19937_64 random(18);
  const auto found = [&random](const MatcherSettings& settings) {
    int count = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Yard yard(seed);
      Matcher matcher(settings);
      for (int start = 0; start < 5; ++start) {
        const MatchResult result =
            matcher.match(yard.map, yard.scan, yard.truth * random_pose(random, 1.2, 0.1));
        EXPECT_LE(result.iterations, settings.max_iterations);
        EXPECT_EQ(result.pairs_dropped, 0U);
        count += (result.pose.translation() - yard.truth.translation()).norm() < 0.1 ? 1 : 0;
      }
    }
    return count;
  };
  const int with = found({});
  const int without = found({.few_points = 0});
  EXPECT_GT(with, without);
  EXPECT_GE(with, 90);
}

TEST(Matcher, DoesNotDependOnTheOrderOfThePoints) {
  Yard yard(1);
  std::mt19937_64 random(13);
  const Pose guess = yard.truth * random_pose(random, 0.4, 0.03);
  const Pose once = Matcher({}).match(yard.map, yard.scan, guess).pose;
  std::shuffle(yard.scan.begin(), yard.scan.end(), random);
  const Pose again = Matcher({}).match(yard.map, yard.scan, guess).pose;
  EXPECT_LT((once.translation() - again.translation()).norm(), 1e-4);
}

TEST(Matcher, WorksAMillionMetresFromTheOrigin) {
  std::mt19937_64 random(14);
  const Pose offset = random_pose(random, 0.4, 0.03);
  const Yard here(2);
  const Pose near = Matcher({}).match(here.map, here.scan, here.truth * offset).pose;
  for (const Eigen::Vector3d& origin_m :
       {Eigen::Vector3d(1e6, -1e6, 1000.0), Eigen::Vector3d(-3.0, 999999.0, -7.0)}) {
    const Yard there(2, origin_m);
    const Pose far = Matcher({}).match(there.map, there.scan, there.truth * offset).pose;
    EXPECT_LT((far.translation() - origin_m - near.translation()).norm(), 1e-4);
    EXPECT_LT(angle_between(far, near), 1e-5);
  }
}

TEST(Matcher, ScoresThePointsAboveTheGroundByThemselves) {
  const Yard yard(8);
  constexpr auto kAbove_m = static_cast<float>(kAboveGround_m);
  const auto above = std::count_if(yard.scan.begin(), yard.scan.end(),
                                   [](const Eigen::Vector3f& point) { return point.z() > kAbove_m; });
  const MatchResult result = Matcher({}).match(yard.map, yard.scan, yard.truth);
  EXPECT_GT(result.no_ground_points_matched, 0.9 * static_cast<double>(above));
  EXPECT_LE(result.no_ground_points_matched, static_cast<std::size_t>(above));
  EXPECT_GT(result.no_ground_nearest_voxel_likelihood, 0.6 * kConstants.d1);

  // Walls and poles that the map does not have stand on its ground: only this score tells.
  std::vector<Eigen::Vector3f> elsewhere;
  const Eigen::Matrix3f to_vehicle = yard.truth.linear().transpose().cast<float>();
  for (Eigen::Vector3f point : yard.scan) {
    if (point.z() > kAbove_m) point += to_vehicle * Eigen::Vector3f(0.5F, 0.5F, 3.0F);
    elsewhere.push_back(point);
  }
  MatcherSettings still;
  still.max_iterations = 1;
  const MatchResult moved_walls = Matcher(still).match(yard.map, elsewhere, yard.truth);
  EXPECT_LT(moved_walls.no_ground_points_matched, result.no_ground_points_matched);
  EXPECT_LT(moved_walls.no_ground_nearest_voxel_likelihood, 0.9 * result.no_ground_nearest_voxel_likelihood);

  const std::vector<Eigen::Vector3f> ground(1, Eigen::Vector3f(0.0F, 0.0F, -50.0F));
  const MatchResult none = Matcher({}).match(yard.map, ground, yard.truth);
  EXPECT_EQ(none.no_ground_points_matched, 0U);
  EXPECT_EQ(none.no_ground_nearest_voxel_likelihood, 0.0);
}

TEST(Matcher, ReturnsTheGuessWhereNothingOverlaps) {
  const Yard yard(4);
  const Pose far = make_pose({5000.0, 0.0, 0.0}, {.yaw_rad = 0.3});
  const MatchResult result = Matcher({}).match(yard.map, yard.scan, far);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.points_matched, 0U);
  EXPECT_EQ((result.pose.matrix() - far.matrix()).norm(), 0.0);

  EXPECT_FALSE(Matcher({}).match(yard.map, {}, yard.truth).converged);
}

TEST(Matcher, LeavesOutPointsThatAreNotFinite) {
  Yard yard(5);
  const Pose clean = Matcher({}).match(yard.map, yard.scan, yard.truth).pose;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  yard.scan.emplace_back(kNan, 0.0F, 0.0F);
  yard.scan.emplace_back(kInfinity, 0.0F, 0.0F);
  yard.scan.emplace_back(1e30F, 0.0F, 0.0F);
  const MatchResult result = Matcher({}).match(yard.map, yard.scan, yard.truth);
  EXPECT_LT((result.pose.matrix() - clean.matrix()).norm(), 1e-4);
}

TEST(Matcher, KeepsTheWideAnswerForTooFewPoints) {
  Yard yard(6);
  yard.scan.resize(150);
  EXPECT_FALSE(Matcher({}).match(yard.map, yard.scan, yard.truth).sharpened);
}

TEST(Matcher, DoesNotMoveAlongADirectionThatNothingHolds) {
  // One horizontal plane: x, y and yaw are free, z, roll and pitch are held.
  std::mt19937_64 random(15);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::vector<Eigen::Vector3d> plane;
  for (int i = 0; i < 400000; ++i)
    plane.emplace_back(30.0 * unit(random), 30.0 * unit(random), noise(random) + 0.5);
  const MapImage image = build_map(plane, kResolution_m);
  const VoxelMap map(image.bytes());
  plane.resize(1000);
  for (Eigen::Vector3d& p : plane) p.head<2>() *= 0.3;
  const Pose truth = make_pose({0.0, 0.0, 2.0}, {});
  const auto scan = seen_from(plane, truth);
  const MatchResult result = Matcher({}).match(map, scan, make_pose({0.0, 0.0, 2.2}, {.pitch_rad = 0.02}));
  EXPECT_NEAR(result.pose.translation().z(), 2.0, 0.02);
  EXPECT_LT(result.pose.translation().head<2>().norm(), 0.5);
  EXPECT_GT(result.covariance(0, 0), 20.0 * result.covariance(2, 2));
}

// A clock that passes a second whenever it is asked.
std::int64_t asked_s = 0;
std::int64_t ask_clock() noexcept { return ++asked_s; }

TEST(Matcher, StopsAtItsDeadlineAndSaysSo) {
  const Yard yard(3);
  Matcher matcher({});
  Pose guess = yard.truth;
  guess.translation().x() += 0.4;
  const MatchResult whole = matcher.match(yard.map, yard.scan, guess);
  ASSERT_TRUE(whole.converged);
  ASSERT_FALSE(whole.out_of_time);
  ASSERT_GT(whole.iterations, 4);
  for (const std::int64_t deadline_s : {0, 1, 4}) {
    asked_s = 0;
    const MatchResult cut =
        matcher.match(yard.map, yard.scan, guess, std::nullopt, {.now_ns = ask_clock, .at_ns = deadline_s});
    EXPECT_TRUE(cut.out_of_time) << deadline_s;
    EXPECT_FALSE(cut.converged) << deadline_s;
    EXPECT_LE(cut.iterations, deadline_s + 1) << deadline_s;
    EXPECT_EQ(asked_s, std::max<std::int64_t>(1, deadline_s)) << "it goes on asking when it is too late";
  }
  asked_s = 0;
  const MatchResult in_time =
      matcher.match(yard.map, yard.scan, guess, std::nullopt, {.now_ns = ask_clock, .at_ns = 1000});
  EXPECT_FALSE(in_time.out_of_time);
  EXPECT_EQ(in_time.pose.matrix(), whole.pose.matrix());
}

}  // namespace
}  // namespace landfix::ndt::test
