#include "ndt/voxel_moments.hpp"

#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace landfix::ndt {
namespace {

[[nodiscard]] Eigen::Matrix3d matrix_of(const Symmetric3f& s) {
  Eigen::Matrix3f matrix;
  matrix << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  return matrix.cast<double>();
}

/// The direction that the voxel holds most, and how much less it holds the next: [1/m^2] over [1/m^2].
struct Hold {
  Eigen::Vector3d direction;
  double over_next = 0.0;
};

[[nodiscard]] Hold hold_of(const Voxel& voxel) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(matrix_of(voxel.sharp_1pm2));
  return {eigen.eigenvectors().col(2), eigen.eigenvalues()[2] / eigen.eigenvalues()[1]};
}

/// As a beam that looks down 10 degrees along x sees a plane through the origin: an arc across, thin along
/// the beam by its noise and thinner still across it.
[[nodiscard]] VoxelMoments ring_on_ground(double at_x_m) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> across_m(-0.5, 0.5);
  std::normal_distribution<double> noise_m(0.0, 0.02);
  const double down_rad = 10.0 * 3.14159265 / 180.0;
  VoxelMoments moments;
  for (int i = 0; i < 40; ++i) {
    const double along_m = noise_m(random);
    moments.add(at_x_m + along_m * std::cos(down_rad), across_m(random), -along_m * std::sin(down_rad));
  }
  return moments;
}

TEST(VoxelMomentsTest, OfTwoCellsAreThoseOfAllTheirPoints) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> place_m(0.1, 0.4);
  VoxelMoments here;
  VoxelMoments there;
  VoxelMoments all;
  for (int i = 0; i < 50; ++i) {
    const double x = place_m(random);
    const double y = place_m(random);
    const double z = place_m(random);
    all.add(x, y, z);
    if (i % 3 == 0)
      here.add(x, y, z);
    else
      there.add(x - 2.0, y + 1.0, z - 3.0);  // about a centre at (2, -1, 3)
  }
  here.add(there, {2.0, -1.0, 3.0});
  EXPECT_EQ(here.count, all.count);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(here.sum_m[i], all.sum_m[i], 1e-9);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(here.squares_m2[i], all.squares_m2[i], 1e-9);
}

TEST(VoxelMomentsTest, ASingleRingHoldsTheSurfaceAroundItAndNotItself) {
  const VoxelMoments ring = ring_on_ground(0.0);
  const Hold alone = hold_of(to_voxel(ring, 1.0));
  EXPECT_LT(alone.over_next, 10.0) << "it holds along the beam nearly as it does across";
  EXPECT_GT(std::abs(alone.direction.x()), 0.1) << "and across is not upwards";

  VoxelMoments around = ring;
  for (const double x_m : {-1.5, 1.0, 2.0}) around.add(ring_on_ground(x_m), {});
  const Hold on_ground = hold_of(to_voxel(ring, 1.0, &around));
  EXPECT_GT(std::abs(on_ground.direction.z()), 0.999);
  EXPECT_GT(on_ground.over_next, 20.0);

  const Voxel nowhere = to_voxel(ring, 1.0, &ring);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> ball(matrix_of(nowhere.sharp_1pm2));
  EXPECT_NEAR(ball.eigenvalues()[0] / ball.eigenvalues()[2], 1.0, 1e-3) << "no surface is known";
}

TEST(VoxelMomentsTest, APoleStaysAPole) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> up_m(-0.5, 0.5);
  std::normal_distribution<double> noise_m(0.0, 0.02);
  VoxelMoments pole;
  for (int i = 0; i < 40; ++i) pole.add(noise_m(random), noise_m(random), up_m(random));
  const Voxel as_it_is = to_voxel(pole, 1.0);
  const Voxel among_nothing = to_voxel(pole, 1.0, &pole);
  EXPECT_EQ(as_it_is.sharp_1pm2, among_nothing.sharp_1pm2);
}

}  // namespace
}  // namespace landfix::ndt
