#include "ndt/covariance.hpp"

#include <iostream>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "ndt/matcher.hpp"
#include "ndt/random_world.hpp"
#include "ndt/voxel_grid.hpp"

namespace landfix::ndt::test {
namespace {

[[nodiscard]] Twist angles_and_place(const Pose& pose) {
  const RollPitchYaw angles = to_roll_pitch_yaw(pose.linear());
  return (Twist() << pose.translation(), angles.roll_rad, angles.pitch_rad, angles.yaw_rad).finished();
}

[[nodiscard]] Matrix6 random_covariance(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Matrix6 half = Matrix6::NullaryExpr([&] { return normal(random); });
  return half * half.transpose();
}

TEST(PoseCovariance, OfRollPitchYawAgreesWithDifferences) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20; ++i) {
    const Pose pose = make_pose(
        {1.0, 2.0, 3.0}, {.roll_rad = 0.1 * i - 1.0, .pitch_rad = 0.12 * i - 1.2, .yaw_rad = 0.29 * i - 2.9});
    Matrix6 jacobian;
    Matrix6 of_vehicle;
    constexpr double kStep = 1e-6;
    for (int k = 0; k < 6; ++k) {
      const auto difference = [&](const Twist& step) {
        return ((angles_and_place(moved(pose, step)) - angles_and_place(moved(pose, -step))) / (2.0 * kStep))
            .eval();
      };
      jacobian.col(k) = difference(kStep * Twist::Unit(k));
      Twist in_map = Twist::Zero();
      in_map.segment<3>(k / 3 * 3) = kStep * pose.linear().col(k % 3);
      of_vehicle.col(k) = difference(in_map);
    }
    const Matrix6 covariance = random_covariance(random);
    const double scale = covariance.norm() * jacobian.squaredNorm();
    EXPECT_LT((to_roll_pitch_yaw_covariance(covariance, pose) - jacobian * covariance * jacobian.transpose())
                  .norm(),
              1e-6 * scale);
    EXPECT_LT(
        (from_vehicle_covariance(covariance, pose) - of_vehicle * covariance * of_vehicle.transpose()).norm(),
        1e-6 * scale);
    EXPECT_LT((to_vehicle_covariance(from_vehicle_covariance(covariance, pose), pose) - covariance).norm(),
              1e-9 * scale);
  }
}

/// Yards, scans of 2,000 points of them, starts: (error' covariance^-1 error) / 6.
TEST(PoseCovariance, IsWhatTheErrorsAre) {
  constexpr int kWorlds = 40;
  constexpr int kScans = 5;
  constexpr std::size_t kMapPoints = 40000;
  constexpr std::size_t kScanPoints = 2000;
  std::mt19937_64 random(2);
  double sum = 0.0;
  Twist each = Twist::Zero();
  Matcher matcher({});
  VoxelGrid grid(0.5, kScanPoints);
  for (std::uint64_t seed = 0; seed < kWorlds; ++seed) {
    const auto world = random_yard(seed, kMapPoints + kScans * kScanPoints);
    const MapImage image = build_map({world.begin(), world.begin() + kMapPoints}, 1.0);
    for (int scan = 0; scan < kScans; ++scan) {
      const auto first = world.begin() + static_cast<std::ptrdiff_t>(
                                             kMapPoints + static_cast<std::size_t>(scan) * kScanPoints);
      const Pose truth = random_pose(random, 1.0, 0.5);
      // Filtered, as scans are: neighbours follow each other.
      grid.clear();
      for (const Eigen::Vector3f& point_m : seen_from({first, first + kScanPoints}, truth)) grid.add(point_m);
      const auto points_m = grid.finish();
      const MatchResult result =
          matcher.match(VoxelMap(image.bytes()), points_m, truth * random_pose(random, 0.3, 0.02));
      ASSERT_TRUE(result.converged);
      const Twist error = angles_and_place(result.pose) - angles_and_place(truth);
      sum += error.dot(result.covariance.ldlt().solve(error)) / 6.0;
      each += Twist(error.cwiseAbs2().cwiseQuotient(result.covariance.diagonal()));
    }
  }
  constexpr double kCount = kWorlds * kScans;
  std::cout << "normalised error squared a degree of freedom " << sum / kCount << "; of x y z roll pitch yaw "
            << each.transpose() / kCount << '\n';
  EXPECT_GT(sum / kCount, 0.5);
  EXPECT_LT(sum / kCount, 2.0);
  EXPECT_GT(each.minCoeff() / kCount, 0.2);
  EXPECT_LT(each.maxCoeff() / kCount, 4.0);
}

TEST(PoseCovariance, IsPositiveDefiniteWhateverTheScan) {
  const auto world = random_yard(4, 41200);
  const MapImage image = build_map({world.begin(), world.begin() + 40000}, 1.0);
  for (const std::size_t points : {1U, 3U, 60U, 130U, 1200U}) {
    const auto scan =
        seen_from({world.end() - static_cast<std::ptrdiff_t>(points), world.end()}, Pose::Identity());
    const MatchResult result =
        Matcher({}).match(VoxelMap(image.bytes()), scan, make_pose({0.1, 0.1, 0.0}, {}));
    EXPECT_LT((result.covariance - result.covariance.transpose()).norm(), 1e-9 * result.covariance.norm());
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(result.covariance);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), 0.0) << points;
    EXPECT_TRUE(result.covariance.allFinite()) << points;
  }
}

TEST(PoseCovariance, KnowsNothingWhereNothingOverlaps) {
  const MapImage image = build_map(random_yard(5, 40000), 1.0);
  const MatchResult result = Matcher({}).match(VoxelMap(image.bytes()), {}, Pose::Identity());
  EXPECT_GE(result.covariance.diagonal().minCoeff(), 1e6);
}

}  // namespace
}  // namespace landfix::ndt::test
