#include "ndt/voxel_moments.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace landfix::ndt {
namespace {

/// A wide voxel is at least a tenth as thick as it is long (Magnusson): its inverse stays bounded.
constexpr double kSmallestEigenvalueRatio = 0.01;
/// A sharp voxel is as thin as its points, but no survey is better than this.
constexpr double kThinnest_m = 0.005;
/// A scan's points lie farther from a surface than those it was surveyed with: they have a noise of their
/// own, and another viewpoint. So variances count for more, but not those of the surface's extent. Tuned on a
/// real drive, where the median error falls by a fifth.
constexpr double kVarianceFactor = 1.0 / 0.3;
constexpr double kExtent_m = 0.2;
/// Where few points of a surface reach into a cell beyond its border, they are its edge and not its middle:
/// their spread is blurred by so many resolutions over their number.
constexpr double kFewPoints = 0.15;
/// Points closer together than this have no shape.
constexpr double kSmallestExtent_m = 1e-4;

[[nodiscard]] Symmetric3f inverse(const Eigen::Matrix3d& axes, const Eigen::Array3d& variances_m2) {
  const Eigen::Matrix3d scaled = axes * variances_m2.inverse().matrix().asDiagonal();
  const auto element = [&](Eigen::Index row, Eigen::Index column) {
    return static_cast<float>(scaled.row(row).dot(axes.row(column)));
  };
  return {element(0, 0), element(0, 1), element(0, 2), element(1, 1), element(1, 2), element(2, 2)};
}

[[nodiscard]] Eigen::Array3d wide(const Eigen::Array3d& variances_m2, double inflation_m2) {
  const Eigen::Array3d inflated_m2 = variances_m2 + inflation_m2;
  return inflated_m2.max(kSmallestEigenvalueRatio * inflated_m2.maxCoeff());
}

[[nodiscard]] Eigen::Array3d sharp(const Eigen::Array3d& variances_m2, double blur_m) {
  const Eigen::Array3d bounded_m2 = variances_m2.max(kThinnest_m * kThinnest_m) + blur_m * blur_m;
  return (kVarianceFactor * bounded_m2).min(bounded_m2.max(kExtent_m * kExtent_m));
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

/// A normal distribution's axes, as columns, and its variances along them, smallest first.
struct Shape {
  Eigen::Matrix3d axes;
  Eigen::Array3d variances_m2;
};

[[nodiscard]] Shape shape_of(const VoxelMoments& moments) noexcept {
  // In closed form: what it loses against the iteration lies far below the bound of the smallest axis.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(covariance_of(moments));
  return {eigen.eigenvectors(), eigen.eigenvalues()};
}

/// The points of a single ring lie on a line, and how thin it is across says how thin a beam is, not where
/// the surface is: matched as it is, a map of few sweeps holds the next ones where these stood. So its
/// surface is that of `around`, where many rings lie in a plane; else it is a place where something is,
/// without a direction, or if it is steep the pole that it seems.
[[nodiscard]] Shape without_ring(const Shape& line, const VoxelMoments& around) noexcept {
  constexpr double kThin = 0.04;  // of the length, squared
  constexpr double kSteep = 0.7;  // cosine to the vertical
  if (line.variances_m2[1] >= kThin * line.variances_m2[2]) return line;
  const double length_m2 = line.variances_m2[2];
  const Shape surface = shape_of(around);
  const Eigen::Vector3d normal = surface.axes.col(0);
  const Eigen::Vector3d along = line.axes.col(2);
  const bool is_plane = surface.variances_m2[0] < kThin * surface.variances_m2[1] &&
                        surface.variances_m2[1] > kThin * surface.variances_m2[2];
  if (is_plane && std::abs(normal.dot(along)) < kSteep) {
    Shape disc{.axes = {}, .variances_m2 = {line.variances_m2[0], length_m2, length_m2}};
    disc.axes.col(0) = normal;
    disc.axes.col(1) = normal.cross(along).normalized();
    disc.axes.col(2) = disc.axes.col(1).cross(normal);
    return disc;
  }
  if (std::abs(along.z()) >= kSteep) return line;
  return {line.axes, Eigen::Array3d::Constant(length_m2)};
}

}  // namespace

void VoxelMoments::add(const VoxelMoments& more, const std::array<double, 3>& from_here_m) noexcept {
  const double n = more.count;
  const auto& [x, y, z] = from_here_m;
  const auto& s = more.sum_m;
  const std::array<double, 6> shifted{2.0 * s[0] * x + n * x * x,      s[0] * y + s[1] * x + n * x * y,
                                      s[0] * z + s[2] * x + n * x * z, 2.0 * s[1] * y + n * y * y,
                                      s[1] * z + s[2] * y + n * y * z, 2.0 * s[2] * z + n * z * z};
  count += more.count;
  for (std::size_t i = 0; i < 3; ++i) sum_m[i] += s[i] + n * from_here_m[i];
  for (std::size_t i = 0; i < 6; ++i) squares_m2[i] += more.squares_m2[i] + shifted[i];
}

bool has_shape(const VoxelMoments& moments) noexcept {
  return moments.count >= kMinVoxelPoints &&
         covariance_of(moments).trace() > kSmallestExtent_m * kSmallestExtent_m;
}

Voxel to_voxel(const VoxelMoments& moments, double resolution_m, const VoxelMoments* around) noexcept {
  Shape shape = shape_of(moments);
  if (around != nullptr) shape = without_ring(shape, *around);
  // The inflation that makes Autoware's voxels robust, as what it is: I / (n - 1) at a resolution of 1 m. It
  // leaves the axes as they are.
  const double inflation_m2 = resolution_m * resolution_m / (moments.count - 1.0);
  const Eigen::Vector3d mean_m = mean_of(moments);
  Voxel voxel;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    voxel.mean_m[axis] = static_cast<float>(mean_m[static_cast<Eigen::Index>(axis)] + 0.5 * resolution_m);
  }
  voxel.count = moments.count;
  const double blur_m = kFewPoints * resolution_m / (moments.count - 1.0);
  voxel.sharp_1pm2 = inverse(shape.axes, sharp(shape.variances_m2, blur_m));
  voxel.wide_1pm2 = inverse(shape.axes, wide(shape.variances_m2, inflation_m2));
  return voxel;
}

}  // namespace landfix::ndt
