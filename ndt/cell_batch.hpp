// The SIMD part of the scan filters: the cells in which points lie, many at a time.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

namespace landfix::ndt {

/// Cell (i, j, k) spans [i, i+1) x [j, j+1) x [k, k+1) times the leaf. Indices are biased so that none is
/// negative: they have 18 bits. Positions beyond have no cell: at a leaf of 5 cm, those 6.5 km away.
inline constexpr std::int32_t kIndexBias = 1 << 17;

/// A point's place in its cell is a fixed-point number, the nearest 0.06 mm at a leaf of 2 m: 0 to 2^14, both
/// included.
inline constexpr int kPlaceBits = 14;

/// Two cells along each axis make a block of eight. Its key: i, j, k of the block, 17 bits each from the top,
/// then 13 bits that are 0.
inline constexpr int kBlockBits = 17;
inline constexpr int kSpareBits = 64 - 3 * kBlockBits;
[[nodiscard]] constexpr std::uint32_t block_index(std::uint64_t key, int axis) noexcept {
  return static_cast<std::uint32_t>(key >> (64 - (axis + 1) * kBlockBits)) & ((1U << kBlockBits) - 1);
}

/// A point in its cell: places x, y, z, and 1, the number of points.
using Place = std::array<std::uint16_t, 4>;
using CellSum = Eigen::Array4i;  ///< of Places

/// What a cast does, but in one instruction of 16 bytes: compilers make ten of the cast.
[[nodiscard]] inline CellSum widened(const Place& place) noexcept {
  using Halves = std::uint16_t __attribute__((vector_size(16)));
  using Pair = std::uint64_t __attribute__((vector_size(16)));
  const auto halves = std::bit_cast<Halves>(Pair{std::bit_cast<std::uint64_t>(place), 0});
  const Halves words = __builtin_shufflevector(halves, Halves{}, 0, 8, 1, 9, 2, 10, 3, 11);
  return Eigen::Map<const CellSum>(std::bit_cast<std::array<std::int32_t, 4>>(words).data());
}

inline constexpr std::size_t kCellBatch = 128;

struct CellBatch {
  alignas(64) std::array<std::uint64_t, kCellBatch> key;   ///< of the block
  alignas(64) std::array<std::uint32_t, kCellBatch> slot;  ///< hash of it: one more for the next along x
  alignas(64) std::array<std::uint32_t, kCellBatch> cell;  ///< of the block's eight: i, j, k from bit 2 down
  alignas(64) std::array<Place, kCellBatch> place;
};

/// `slot_mask`: the bits that a hash has. False if a point has no cell: then nothing of the batch counts. The
/// same on every instruction set, to the bit.
[[nodiscard]] bool find_cells(std::span<const Eigen::Vector3f, kCellBatch> points_m, float inverse_leaf_1pm,
                              std::uint32_t slot_mask, CellBatch& batch) noexcept;

}  // namespace landfix::ndt
