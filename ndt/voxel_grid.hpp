// The downsampling filter of the input scan: one point, the centroid, for every cell that has points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ndt/cell_batch.hpp"
#include "ndt/cell_moments.hpp"
#include "ndt/spatial_sort.hpp"

namespace landfix::ndt {

struct GridOptions {
  bool by_ring = false;       ///< a cell's points of each ring have a centroid of their own
  bool with_entropy = false;  ///< `entropies` are wanted; takes three times the memory
};

/// Takes points as they are decoded. It sums integers, so that the centroids are the same to the bit in
/// whatever order and portions the points come. Allocates in its constructor only.
class VoxelGrid {
 public:
  /// `leaf_m`: edge of a cell, > 0. `capacity`: centroids that it can hold; points of cells beyond are left
  /// out.
  VoxelGrid(double leaf_m, std::size_t capacity, const GridOptions& options = {});

  void clear() noexcept;
  /// Points that are not finite, or 2^17 cells away, are left out.
  void add(const Eigen::Vector3f& point_m, std::uint16_t ring = 0) noexcept {
    pending_[pending_size_] = point_m;
    pending_rings_[pending_size_] = ring;
    ++pending_size_;
    if (pending_size_ == kCellBatch) add_pending();
  }
  void add(std::span<const Eigen::Vector3f> points_m) noexcept;
  /// The centroids, neighbours in space near each other in memory. The caller may move them; they
  /// are valid until the next `finish`.
  [[nodiscard]] std::span<Eigen::Vector3f> finish() noexcept;

  /// Of the cell of each centroid that `finish` has given, in their order: see entropy_of.
  [[nodiscard]] std::span<const float> entropies() const noexcept { return entropies_; }

  /// Points since `clear` that are in no centroid; known once `finish` has run.
  [[nodiscard]] std::size_t dropped_points() const noexcept { return dropped_points_; }

  /// More could overflow a cell's sum: such a cell is left out.
  static constexpr std::int32_t kMostPointsOfCell = (1 << (31 - kPlaceBits)) - 1;

 private:
  using Points = std::array<Eigen::Vector3f, kCellBatch>;
  using Rings = std::array<std::uint16_t, kCellBatch>;
  static constexpr std::uint32_t kNoRoom = 0;       ///< index of the block for points that find none
  static constexpr std::size_t kBlocksAtOnce = 16;  ///< whose cells are listed and then averaged

  void add_pending() noexcept;
  void add_batch(std::span<const Eigen::Vector3f, kCellBatch> points_m, std::size_t size) noexcept;
  void set_rings() noexcept;
  void blank_from(std::size_t size) noexcept;
  template <bool kWithMoments>
  void sum_batch() noexcept;
  [[nodiscard]] std::uint32_t find_or_open(std::size_t n) noexcept;
  [[nodiscard]] std::span<const SpatialKey> sort_blocks() noexcept;
  [[nodiscard]] std::span<const std::uint32_t> list_cells(std::span<const SpatialKey> order) noexcept;
  void average(std::uint32_t cell, std::size_t n) noexcept;

  double leaf_m_;
  float inverse_leaf_1pm_;
  GridOptions options_;
  std::size_t size_ = 1;  ///< blocks, kNoRoom among them
  std::size_t points_ = 0;
  std::size_t dropped_points_ = 0;
  std::size_t pending_size_ = 0;
  Points pending_;
  Rings pending_rings_{};
  CellBatch batch_;
  // Blocks in the order of their first points, each with its eight cells.
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> slots_;
  std::vector<Eigen::Array4i> corners_;  ///< i, j, k of its lowest cell, 0
  std::vector<CellSum> sums_;
  std::vector<CellMoments> moments_;
  std::vector<std::uint32_t> table_;  ///< of 2^n slots, by hash: indices of blocks; kNoRoom: free
  std::vector<SpatialKey> order_;     ///< and as much scratch
  std::array<std::uint32_t, 8 * kBlocksAtOnce> listed_{};  ///< cells: 8 times the block, and which of its
  std::vector<Eigen::Vector3f> centroids_;                 ///< and one more, see average()
  std::vector<float> entropies_;
};

}  // namespace landfix::ndt
