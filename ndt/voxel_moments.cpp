#include "ndt/voxel_moments.hpp"

#include <Eigen/Eigenvalues>

namespace landfix::ndt {
namespace {

/// A voxel is at least a tenth as thick as it is long (Magnusson): its inverse stays bounded.
constexpr double kSmallestEigenvalueRatio = 0.01;
/// Points closer together than this have no shape.
constexpr double kSmallestExtent_m = 1e-4;

[[nodiscard]] Symmetric3f inverse_of_bounded(const Eigen::Matrix3d& axes,
                                             const Eigen::Vector3d& variances_m2) {
  const Eigen::Vector3d bounded_m2 =
      variances_m2.cwiseMax(kSmallestEigenvalueRatio * variances_m2.maxCoeff());
  const Eigen::Matrix3d scaled = axes * bounded_m2.cwiseInverse().asDiagonal();
  const auto element = [&](Eigen::Index row, Eigen::Index column) {
    return static_cast<float>(scaled.row(row).dot(axes.row(column)));
  };
  return {element(0, 0), element(0, 1), element(0, 2), element(1, 1), element(1, 2), element(2, 2)};
}

[[nodiscard]] Eigen::Vector3d mean_of(const VoxelMoments& moments) noexcept {
  return Eigen::Map<const Eigen::Vector3d>(moments.sum_m.data()) / moments.count;
}

/// [m^2]
[[nodiscard]] Eigen::Matrix3d covariance_of(const VoxelMoments& moments) noexcept {
  const double n = moments.count;
  const Eigen::Vector3d mean_m = mean_of(moments);
  const auto& s = moments.squares_m2;
  Eigen::Matrix3d squares_m2;
  squares_m2 << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  return (squares_m2 - n * mean_m * mean_m.transpose()) / (n - 1.0);
}

}  // namespace

bool has_shape(const VoxelMoments& moments) noexcept {
  return moments.count >= kMinVoxelPoints &&
         covariance_of(moments).trace() > kSmallestExtent_m * kSmallestExtent_m;
}

Voxel to_voxel(const VoxelMoments& moments, double resolution_m) noexcept {
  // In closed form: what it loses against the iteration lies far below the bound of the smallest axis.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(covariance_of(moments));
  // The inflation that makes Autoware's voxels robust, as what it is: I / (n - 1) at a resolution of 1 m. It
  // leaves the axes as they are.
  const double inflation_m2 = resolution_m * resolution_m / (moments.count - 1.0);
  const Eigen::Vector3d mean_m = mean_of(moments);
  Voxel voxel;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    voxel.mean_m[axis] = static_cast<float>(mean_m[static_cast<Eigen::Index>(axis)] + 0.5 * resolution_m);
  }
  voxel.count = moments.count;
  voxel.sharp_1pm2 = inverse_of_bounded(eigen.eigenvectors(), eigen.eigenvalues());
  voxel.wide_1pm2 = inverse_of_bounded(eigen.eigenvectors(), eigen.eigenvalues().array() + inflation_m2);
  return voxel;
}

}  // namespace landfix::ndt
