// Builds a voxel map from points in one streaming pass: memory follows the voxels, not the points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "ndt/lattice.hpp"
#include "ndt/map_image.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

class VoxelMapBuilder {
 public:
  /// `resolution_m`: edge of a voxel, see is_resolution. `capacity`: cells that points may fall in; no point
  /// after the last of them is taken. Throws std::runtime_error where the memory cannot be had.
  VoxelMapBuilder(double resolution_m, std::size_t capacity);

  /// Throws std::runtime_error where a point opens a cell beyond the capacity. A point that is not finite or
  /// beyond the lattice is skipped and counted.
  void add(const Eigen::Vector3d& point_m);

  [[nodiscard]] std::uint64_t points() const noexcept { return points_; }
  [[nodiscard]] std::uint64_t skipped_points() const noexcept { return skipped_points_; }
  [[nodiscard]] std::size_t cells() const noexcept { return cells_.size(); }

  /// The finished map: a voxel for each cell with at least kMinPoints points that span a volume. Throws
  /// std::runtime_error if there is none.
  [[nodiscard]] MapImage build() const;

  /// Fewer points say little about a covariance; the number of PCL and its followers.
  static constexpr std::uint32_t kMinPoints = 6;

 private:
  /// Moments of the points of one cell, about its centre so that their differences keep their digits.
  struct CellSums {
    Cell cell;
    std::uint32_t count = 0;
    Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
    std::array<double, 6> squares_m2{};
  };

  [[nodiscard]] CellSums& find_or_add(const Cell& cell);

  double resolution_m_;
  std::size_t capacity_;
  std::vector<CellSums> cells_;
  std::vector<std::uint32_t> table_;  ///< index + 1 into cells_, 0 is empty
  std::uint64_t points_ = 0;
  std::uint64_t skipped_points_ = 0;
};

}  // namespace landfix::ndt
