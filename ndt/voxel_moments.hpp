// From the points of one cell to a voxel: their moments, and the normal distribution that these describe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "ndt/map_layout.hpp"

namespace landfix::ndt {

/// Moments of the points of one cell, about its centre so that their differences keep their digits.
struct VoxelMoments {
  std::array<double, 3> sum_m{};
  std::array<double, 6> squares_m2{};  ///< xx xy xz yy yz zz
  std::uint32_t count = 0;

  void add(double x_m, double y_m, double z_m) noexcept {
    ++count;
    sum_m[0] += x_m;
    sum_m[1] += y_m;
    sum_m[2] += z_m;
    squares_m2[0] += x_m * x_m;
    squares_m2[1] += x_m * y_m;
    squares_m2[2] += x_m * z_m;
    squares_m2[3] += y_m * y_m;
    squares_m2[4] += y_m * z_m;
    squares_m2[5] += z_m * z_m;
  }
  /// Those of another cell, whose centre is there.
  void add(const VoxelMoments& more, const std::array<double, 3>& from_here_m) noexcept;
};

/// Fewer points say little about a covariance; the number of PCL and its followers.
inline constexpr std::uint32_t kMinVoxelPoints = 6;

/// What the points of a cell are.
enum class PointSource : std::uint8_t {
  survey,  ///< they cover the surfaces
  sweeps,  ///< they lie on them in rings, of which a cell may have seen no more than one
};

/// Whether a cell becomes a voxel: at least kMinVoxelPoints points that are not all in one place.
[[nodiscard]] bool has_shape(const VoxelMoments& moments) noexcept;

/// The voxel of a cell that has a shape. `around`: of its neighbourhood too, where a cell may have been seen
/// by a single ring; null: it is as its points lie.
[[nodiscard]] Voxel to_voxel(const VoxelMoments& moments, double resolution_m,
                             const VoxelMoments* around = nullptr) noexcept;

}  // namespace landfix::ndt
