#include "ndt/fitness.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "ndt/random_world.hpp"

namespace landfix::ndt::test {
namespace {

TEST(FitnessScore, IsTheMeanSquaredDistanceToTheNearestMean) {
  const auto cloud = random_yard(1, 20000);
  const MapImage image = build_map(cloud, 1.0);
  const VoxelMap map(image.bytes());
  std::mt19937_64 random(1);
  const Pose pose = random_pose(random, 3.0, 1.0);
  std::vector<Eigen::Vector3d> some(cloud.begin(), cloud.begin() + 200);
  some.emplace_back(300.0, -200.0, 50.0);  // far from every voxel: counts like any other
  const auto scan = seen_from(some, Pose::Identity());

  double sum_m2 = 0.0;
  for (const Eigen::Vector3f& point : scan) {
    double nearest_m2 = std::numeric_limits<double>::infinity();
    visit_voxels(map, [&](const Voxel& /*voxel*/, const Eigen::Vector3d& mean_m) {
      nearest_m2 = std::min(nearest_m2, (pose * point.cast<double>() - mean_m).squaredNorm());
    });
    sum_m2 += nearest_m2;
  }
  const double expected = sum_m2 / static_cast<double>(scan.size());
  EXPECT_NEAR(FitnessScore(map)(scan, pose), expected, 1e-9 * expected);
  EXPECT_TRUE(std::isnan(FitnessScore(map)({}, pose)));
}

}  // namespace
}  // namespace landfix::ndt::test
