// The SIMD part of the scan filters: the cells in which points lie, many at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

namespace landfix::ndt {

/// Cell (i, j, k) spans [i, i+1) x [j, j+1) x [k, k+1) times the leaf. A coordinate is a fixed-point number
/// of cells: an index of 18 bits, biased so that none is negative, and a place in the cell of 14 bits, which
/// is the nearest 0.06 mm at a leaf of 2 m.
inline constexpr int kPlaceBits = 14;
inline constexpr std::int32_t kIndexBias = 1 << (31 - kPlaceBits);
/// Positions from here on have no cell: at a leaf of 5 cm, those beyond 6.5 km.
inline constexpr float kMostCells = kIndexBias - 1;

/// Two cells along each axis make a block of eight. Its key: i, j, k of the block, 17 bits each from the top,
/// then 13 bits that are 0.
inline constexpr int kBlockBits = 31 - kPlaceBits;
inline constexpr int kSpareBits = 64 - 3 * kBlockBits;
[[nodiscard]] constexpr std::uint32_t block_index(std::uint64_t key, int axis) noexcept {
  return static_cast<std::uint32_t>(key >> (64 - (axis + 1) * kBlockBits)) & ((1U << kBlockBits) - 1);
}

/// Sums of coordinates x, y, z, modulo 2^32, and how many there are. All points of a cell have its index, so
/// that the sum of their places in it can be told from this.
using CellSum = std::array<std::uint32_t, 4>;

inline constexpr std::size_t kCellBatch = 128;

struct CellBatch {
  alignas(64) std::array<std::uint64_t, kCellBatch> block;  ///< key
  alignas(64) std::array<std::uint32_t, kCellBatch> hash;   ///< of the block: one more for the next along x
  alignas(64) std::array<std::uint32_t, kCellBatch> cell;   ///< of the block's eight: i, j, k from bit 2 down
  alignas(64) std::array<CellSum, kCellBatch> point;        ///< the sum of one
};

/// False if a point is not finite or lies beyond kMostCells: then nothing of the batch counts. The same on
/// every instruction set, to the bit.
[[nodiscard]] bool find_cells(std::span<const Eigen::Vector3f, kCellBatch> points_m, float inverse_leaf_1pm,
                              CellBatch& batch) noexcept;

}  // namespace landfix::ndt
