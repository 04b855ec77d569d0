// The downsampling filter of the input scan: one point, the centroid, for every cell that has points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ndt/lattice.hpp"

namespace landfix::ndt {

/// Takes points one by one, as they are decoded. Allocates in its constructor only.
class VoxelGrid {
 public:
  /// `leaf_m`: edge of a cell, > 0. `capacity`: cells it can hold; a point that would open one more is
  /// counted and left out.
  VoxelGrid(double leaf_m, std::size_t capacity);

  void clear() noexcept;
  /// A point that is not finite is left out.
  void add(const Eigen::Vector3f& point_m) noexcept;
  /// The centroids, neighbours in space near each other in memory. Valid until the next `clear`.
  [[nodiscard]] std::span<const Eigen::Vector3f> finish() noexcept;

  [[nodiscard]] std::size_t dropped_points() const noexcept { return dropped_points_; }

 private:
  struct CellSum {
    std::uint64_t key = 0;  ///< of the cell, the bits of its indices interleaved
    Eigen::Vector3f sum_m = Eigen::Vector3f::Zero();
    std::uint32_t count = 0;
  };
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t generation = 0;  ///< empty unless it is the current one, so that clearing touches nothing
    std::uint32_t index = 0;
  };

  float inverse_leaf_1pm_;
  std::uint32_t generation_ = 1;
  unsigned hash_shift_;
  std::size_t size_ = 0;
  std::size_t dropped_points_ = 0;
  std::vector<Slot> table_;
  std::vector<CellSum> cells_;
  std::vector<Eigen::Vector3f> centroids_;
};

}  // namespace landfix::ndt
