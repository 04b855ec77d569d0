// The lattice that all voxel maps share: cell (i, j, k) spans [i, i+1) x [j, j+1) x [k, k+1) times the
// resolution, whatever the map's place. 4 x 4 x 4 cells make a block, addressed by one 64-bit key; a bit of a
// 64-bit mask is a cell of it.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace landfix::ndt {

struct Cell {
  std::int32_t i = 0;
  std::int32_t j = 0;
  std::int32_t k = 0;

  friend bool operator==(const Cell&, const Cell&) = default;
};

/// Cells of larger index would not fit a block key: at 1 m, 4,000 km.
inline constexpr std::int32_t kMaxCell = 1 << 22;

/// Whether cells can be of this size [m]; beyond, single precision gives out.
[[nodiscard]] constexpr bool is_resolution(double resolution_m) noexcept {
  return resolution_m >= 0.001 && resolution_m <= 1000.0;  // NaN is not
}

/// A point as its cell and its place in it, which single precision resolves to 60 nm at 1 m, wherever the map
/// is.
struct LatticePoint {
  Cell cell;
  Eigen::Vector3f offset_m;  ///< from the cell's lower corner
  bool inside = false;       ///< within kMaxCell; NaN is not
};

/// Whether a position in units of cells has a cell, with room for its neighbours; NaN has none.
[[nodiscard]] inline bool has_cell(const Eigen::Vector3d& cells) noexcept {
  constexpr double kLimit = kMaxCell - 8;
  return std::abs(cells.x()) < kLimit && std::abs(cells.y()) < kLimit && std::abs(cells.z()) < kLimit;
}

/// std::floor of what fits, which without SSE4.1 is a call.
[[nodiscard]] constexpr std::int32_t floor_of(double value) noexcept {
  const auto truncated = static_cast<std::int32_t>(value);
  return truncated - (truncated > value ? 1 : 0);
}

/// The cell of a position in units of cells that has one.
[[nodiscard]] inline Cell cell_of(const Eigen::Vector3d& cells) noexcept {
  return {floor_of(cells.x()), floor_of(cells.y()), floor_of(cells.z())};
}

[[nodiscard]] inline LatticePoint to_lattice(const Eigen::Vector3d& point_m, double resolution_m,
                                             double inverse_resolution_1pm) noexcept {
  const Eigen::Vector3d scaled = point_m * inverse_resolution_1pm;
  if (!has_cell(scaled)) return {};
  const Cell cell = cell_of(scaled);
  const Eigen::Vector3d lower(cell.i, cell.j, cell.k);
  return {.cell = cell, .offset_m = (point_m - lower * resolution_m).cast<float>(), .inside = true};
}

/// 21 bits an axis, x highest.
[[nodiscard]] constexpr std::uint64_t block_key(std::int32_t bi, std::int32_t bj, std::int32_t bk) noexcept {
  constexpr std::uint64_t kMask = (1U << 21) - 1;
  return ((static_cast<std::uint64_t>(bi) & kMask) << 42) | ((static_cast<std::uint64_t>(bj) & kMask) << 21) |
         (static_cast<std::uint64_t>(bk) & kMask);
}
[[nodiscard]] constexpr std::uint64_t block_key(const Cell& cell) noexcept {
  return block_key(cell.i >> 2, cell.j >> 2, cell.k >> 2);
}

/// The lower corner of a block, from its key.
[[nodiscard]] constexpr Cell block_corner(std::uint64_t key) noexcept {
  // Shifting up and arithmetically down again restores the sign of a 21-bit field, times four.
  const auto axis = [](std::uint64_t field) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(field) << 11) >> 9;
  };
  return {axis(key >> 42), axis(key >> 21), axis(key)};
}

/// Bit of a cell in its block's mask: x fastest.
[[nodiscard]] constexpr unsigned cell_bit(const Cell& cell) noexcept {
  return static_cast<unsigned>((cell.i & 3) | ((cell.j & 3) << 2) | ((cell.k & 3) << 4));
}

/// The cell of a bit, from the corner of its block.
[[nodiscard]] constexpr Cell cell_in_block(unsigned bit) noexcept {
  const auto index = static_cast<std::int32_t>(bit);
  return {index & 3, (index >> 2) & 3, index >> 4};
}

/// Three coordinates of a key, each from 0 on, interleaved bit by bit: in the order of this code neighbours
/// in space are neighbours in memory, and an aligned cube of 2^n blocks a side is one run (Morton, 1966).
[[nodiscard]] constexpr std::uint64_t morton_code(std::uint64_t key) noexcept {
  const auto spread = [key](unsigned shift) {
    constexpr std::uint64_t kField = (1U << 21) - 1;
    constexpr std::uint64_t kSignToFront = 1U << 20;
    std::uint64_t bits = ((key >> shift) & kField) ^ kSignToFront;
    bits = (bits | bits << 32) & 0x001F00000000FFFF;
    bits = (bits | bits << 16) & 0x001F0000FF0000FF;
    bits = (bits | bits << 8) & 0x100F00F00F00F00F;
    bits = (bits | bits << 4) & 0x10C30C30C30C30C3;
    return (bits | bits << 2) & 0x1249249249249249;
  };
  return spread(0) | spread(21) << 1 | spread(42) << 2;
}

/// Mixes a key so that its high bits index a table of a power of two (Fibonacci hashing, after a fold because
/// neighbouring blocks differ in few bits).
[[nodiscard]] constexpr std::uint64_t hash_key(std::uint64_t key) noexcept {
  key ^= key >> 32;
  return key * 0x9E3779B97F4A7C15U;
}

}  // namespace landfix::ndt
