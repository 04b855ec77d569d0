// The downsampling filter of the input scan: one point, the centroid, for every cell that has points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ndt/cell_batch.hpp"
#include "ndt/spatial_sort.hpp"

namespace landfix::ndt {

/// Takes points as they are decoded. It sums integers, so that the centroids are the same to the bit in
/// whatever order and portions the points come. Allocates in its constructor only.
class VoxelGrid {
 public:
  /// `leaf_m`: edge of a cell, > 0. `capacity`: centroids that it can hold; points of cells beyond are left
  /// out.
  VoxelGrid(double leaf_m, std::size_t capacity);

  void clear() noexcept;
  /// Points that are not finite, or kMostCells away, are left out.
  void add(const Eigen::Vector3f& point_m) noexcept {
    pending_[pending_size_++] = point_m;
    if (pending_size_ == kCellBatch) add_pending();
  }
  void add(std::span<const Eigen::Vector3f> points_m) noexcept;
  /// The centroids, neighbours in space near each other in memory. The caller may move them; they
  /// are valid until the next `finish`.
  [[nodiscard]] std::span<Eigen::Vector3f> finish() noexcept;

  /// Points since `clear` that are in no centroid; known once `finish` has run.
  [[nodiscard]] std::size_t dropped_points() const noexcept { return dropped_points_; }

  /// More would overflow a cell's sum: such a cell is left out.
  static constexpr std::uint32_t kMostPointsOfCell = 1U << (32 - kPlaceBits);

 private:
  using Points = std::array<Eigen::Vector3f, kCellBatch>;
  using Block = std::array<CellSum, 8>;
  static constexpr std::uint32_t kNoRoom = 0;  ///< index of the block for points that find none

  void add_pending() noexcept;
  void add_batch(std::span<const Eigen::Vector3f, kCellBatch> points_m, std::size_t size) noexcept;
  void sum_batch(std::size_t size) noexcept;
  [[nodiscard]] std::uint32_t find_or_open(std::uint64_t key, std::uint32_t hash) noexcept;
  [[nodiscard]] std::span<const std::uint32_t> list_cells() noexcept;
  [[nodiscard]] std::span<const SpatialKey> sort_blocks() noexcept;
  [[nodiscard]] Eigen::Vector3f centroid(std::uint64_t key, std::uint32_t cell,
                                         const CellSum& sum) const noexcept;

  double leaf_m_;
  std::size_t size_ = 1;  ///< blocks, kNoRoom among them
  std::size_t points_ = 0;
  std::size_t dropped_points_ = 0;
  std::size_t pending_size_ = 0;
  Points pending_;
  CellBatch batch_;
  // Blocks in the order of their first points.
  std::vector<std::uint64_t> keys_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> slots_;
  std::vector<std::uint32_t> table_;  ///< of 2^n slots, by hash: indices of blocks; kNoRoom: free
  std::vector<SpatialKey> order_;     ///< and as much scratch
  std::vector<std::uint32_t>
      cells_;  ///< that have points, in order: 8 times the block, and which of its cells
  std::vector<Eigen::Vector3f> centroids_;
};

}  // namespace landfix::ndt
