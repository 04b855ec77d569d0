#include "ndt/degeneracy.hpp"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ndt/assessment.hpp"
#include "ndt/covariance.hpp"
#include "ndt/degenerate_world.hpp"
#include "ndt/matcher.hpp"
#include "ndt/random_world.hpp"

namespace landfix::ndt::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

constexpr double kYaw_rad = 0.3;  // of the corridor: not along the voxels

[[nodiscard]] std::vector<Eigen::Vector3d> turned(std::vector<Eigen::Vector3d> cloud) {
  for (Eigen::Vector3d& point_m : cloud) point_m = to_rotation({.yaw_rad = kYaw_rad}) * point_m;
  return cloud;
}

[[nodiscard]] std::vector<Axis> axes(const WeakDirections& weak) {
  std::vector<Axis> axes;
  for (const WeakDirection& direction : weak.all()) axes.push_back(direction.axis);
  return axes;
}

[[nodiscard]] MatchResult match(const std::vector<Eigen::Vector3d>& world,
                                const std::vector<Eigen::Vector3d>& seen, const Pose& truth,
                                const Pose& guess) {
  const MapImage image = build_map(world, 1.0);
  return Matcher({}).match(VoxelMap(image.bytes()), seen_from(seen, truth), guess);
}

TEST(Degeneracy, InACorridorItIsTheDirectionAlongIt) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    std::mt19937_64 random(seed);
    const Pose truth = make_pose({0.1 * static_cast<double>(seed), 0.0, 0.0}, {.yaw_rad = kYaw_rad});
    // Off by 0.3 m along, as well as in every direction.
    Pose guess = truth * random_pose(random, 0.2, 0.02);
    guess.translation() += 0.3 * truth.linear().col(0);
    const MatchResult result = match(turned(corridor(seed, 80000, -40.0, 40.0)),
                                     turned(corridor(seed + 100, 1000, -15.0, 15.0)), truth, guess);
    ASSERT_THAT(axes(result.weak), ElementsAre(Axis::longitudinal)) << seed;
    EXPECT_NEAR(std::abs(result.weak.at[0].direction[0]), 1.0, 0.02);
    const Twist sigma = to_vehicle_covariance(result.covariance, result.pose).diagonal().cwiseSqrt();
    EXPECT_NEAR(result.weak.at[0].sigma, sigma[0], 1e-3);
    EXPECT_NEAR(sigma[0], 1.0, 0.05);
    EXPECT_GT(sigma[0], 10.0 * sigma.segment<2>(1).maxCoeff());
    // Along, the guess is kept; the rest is found.
    const Eigen::Vector3d of_guess =
        truth.linear().transpose() * (result.pose.translation() - guess.translation());
    const Eigen::Vector3d of_truth =
        truth.linear().transpose() * (result.pose.translation() - truth.translation());
    // To within what a guess that leans wrongly moves the vehicle under its points.
    EXPECT_NEAR(of_guess.x(), 0.0, 0.05) << seed;
    EXPECT_LT(of_truth.tail<2>().norm(), 0.03) << seed;
    EXPECT_LT(angle_between(result.pose, truth), 0.005) << seed;
  }
}

TEST(Degeneracy, IsNamedInTheAxesOfTheVehicle) {
  const Pose truth = make_pose({0.0, 0.0, 0.0}, {.yaw_rad = kYaw_rad + 1.55});
  const MatchResult result =
      match(turned(corridor(1, 80000, -40.0, 40.0)), turned(corridor(2, 1000, -15.0, 15.0)), truth, truth);
  EXPECT_THAT(axes(result.weak), ElementsAre(Axis::lateral));
}

TEST(Degeneracy, OnAFieldItIsPositionAndHeading) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Pose truth = make_pose({0.3, 0.1, 0.0}, {.yaw_rad = 0.1 * static_cast<double>(seed)});
    const Pose guess =
        make_pose({0.5, -0.2, 0.2}, {.pitch_rad = 0.01, .yaw_rad = 0.1 * static_cast<double>(seed) + 0.03});
    const MatchResult result = match(field(seed, 100000, 40.0), field(seed + 100, 1000, 15.0), truth, guess);
    EXPECT_THAT(axes(result.weak), UnorderedElementsAre(Axis::longitudinal, Axis::lateral, Axis::yaw))
        << seed;
    const Twist sigma = to_vehicle_covariance(result.covariance, result.pose).diagonal().cwiseSqrt();
    EXPECT_GT(sigma.head<2>().minCoeff(), 10.0 * sigma[2]);
    EXPECT_GT(sigma[5], 10.0 * sigma.segment<2>(3).maxCoeff());
    EXPECT_LT((result.pose.translation() - guess.translation()).head<2>().norm(), 0.02) << seed;
    EXPECT_NEAR(to_roll_pitch_yaw(result.pose.linear()).yaw_rad, to_roll_pitch_yaw(guess.linear()).yaw_rad,
                0.002);
    EXPECT_NEAR(result.pose.translation().z(), 0.0, 0.02);
  }
}

TEST(Degeneracy, IsNoneInAYard) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto world = random_yard(seed, 41200);
    const std::vector<Eigen::Vector3d> map_points(world.begin(), world.begin() + 40000);
    const std::vector<Eigen::Vector3d> seen(world.begin() + 40000, world.end());
    EXPECT_THAT(axes(match(map_points, seen, Pose::Identity(), Pose::Identity()).weak), IsEmpty()) << seed;
  }
}

TEST(Degeneracy, EndsWhereAFewPillarsStand) {
  const std::vector<Eigen::Vector2d> places{{-6.0, 2.0}, {3.5, -2.5}, {9.0, 3.0}, {12.0, -1.0}};
  const auto world = joined(corridor(1, 80000, -40.0, 40.0), pillars(2, 4000, places));
  const auto seen = joined(corridor(3, 1000, -15.0, 15.0), pillars(4, 120, places));
  const Pose guess = make_pose({0.3, 0.05, 0.0}, {});
  const MatchResult result = match(world, seen, Pose::Identity(), guess);
  EXPECT_THAT(axes(result.weak), IsEmpty());
  EXPECT_LT(result.pose.translation().norm(), 0.05);
}

TEST(Assessment, LeavesAPoseThatIsHeldAsItIs) {
  const auto world = random_yard(3, 41200);
  const MapImage image = build_map({world.begin(), world.begin() + 40000}, 1.0);
  const VoxelMap map(image.bytes());
  const auto scan = seen_from({world.begin() + 40000, world.end()}, Pose::Identity());
  PairGroups groups(scan.size());
  groups.assign(scan);
  const Pose optimum = make_pose({0.01, 0.02, -0.01}, {.yaw_rad = 0.001});
  const ScoreConstants constants = magnusson_constants(0.55, 1.0);
  const ScanInformation information = gather_information(map, groups, optimum, Covariance::sharp, constants);
  const Assessment assessment = assess(map, groups, optimum, Covariance::sharp, information, constants,
                                       {.pose = make_pose({0.5, 0.5, 0.0}, {}), .sigma_m = 1.0});
  EXPECT_EQ(assessment.weak.count, 0U);
  EXPECT_EQ((assessment.pose.matrix() - optimum.matrix()).norm(), 0.0);
}

TEST(Assessment, IsAsUncertainAsTheGuessInTheWeakDirections) {
  const MapImage image = build_map(corridor(1, 80000, -40.0, 40.0), 1.0);
  const VoxelMap map(image.bytes());
  const auto scan = seen_from(corridor(2, 1000, -15.0, 15.0), Pose::Identity());
  Matcher matcher({});
  for (const double sigma_m : {0.01, 0.5, 20.0}) {
    const MatchResult result = matcher.match(map, scan, Pose::Identity(), sigma_m);
    ASSERT_EQ(result.weak.count, 1U);
    EXPECT_NEAR(result.weak.at[0].sigma, sigma_m, 0.05 * sigma_m);
  }
}

}  // namespace
}  // namespace landfix::ndt::test
