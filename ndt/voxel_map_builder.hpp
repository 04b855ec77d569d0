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
#include "ndt/voxel_moments.hpp"

namespace landfix::ndt {

class VoxelMapBuilder {
 public:
  /// `resolution_m`: edge of a voxel, see is_resolution. `capacity`: cells that points may fall in; no point
  /// after the last of them is taken. Throws std::runtime_error where the memory cannot be had.
  VoxelMapBuilder(double resolution_m, std::size_t capacity, PointSource source = PointSource::survey);

  /// Throws std::runtime_error where a point opens a cell beyond the capacity. A point that is not finite or
  /// beyond the lattice is skipped and counted.
  void add(const Eigen::Vector3d& point_m);

  /// As if no point had come whose block is farther from the place than that, horizontally.
  void forget_beyond(const Eigen::Vector3d& place_m, double within_m);

  [[nodiscard]] std::uint64_t points() const noexcept { return points_; }
  [[nodiscard]] std::uint64_t skipped_points() const noexcept { return skipped_points_; }
  [[nodiscard]] std::size_t cells() const noexcept { return cells_.size(); }

  /// The finished map: a voxel for each cell with at least kMinVoxelPoints points that span a volume. Throws
  /// std::runtime_error if there is none.
  [[nodiscard]] MapImage build() const;

 private:
  /// Points of one block touch few cells, one after the other: after the block all is near.
  struct Block {
    std::uint64_t key = 0;
    std::array<std::uint32_t, 64> cells{};  ///< index + 1 into cells_, 0: no point yet
  };

  struct PlacedBlock {
    TileBlock in_map;
    std::uint32_t index = 0;  ///< into blocks_
  };

  [[nodiscard]] std::vector<PlacedBlock> blocks_in_order() const;
  [[nodiscard]] VoxelMoments moments_of(const Block& block) const;
  [[nodiscard]] Block& find_or_add(std::uint64_t key);
  void grow_table();

  double resolution_m_;
  double inverse_resolution_1pm_;
  std::size_t capacity_;
  PointSource source_;
  std::vector<VoxelMoments> cells_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> table_;  ///< index + 1 into blocks_, 0: empty
  std::size_t last_block_ = 0;        ///< where the last point fell, as the next one may
  std::uint64_t points_ = 0;
  std::uint64_t skipped_points_ = 0;
};

}  // namespace landfix::ndt
