// What a map image is made of, in memory and on disk alike (little-endian), and where each part begins:
//
//   MapHeader            128 bytes
//   BlockEntry[table]    the hash table of blocks
//   float[3][column]     the means once more: x of all voxels, y, z, each column padded (mean_column_size)
//   Voxel[voxels]        in the order of tiles, of blocks in a tile, of cells in a block
//   TileBlock[blocks]    the blocks once more, in the voxels' order         } absent from an image that is
//   TileEntry[tiles]     the tiles: runs of blocks, and so of voxels        } only a window of a map
//
// A tile is a cube of 4 x 4 x 4 blocks. As blocks are in Morton order, its blocks and voxels are each one
// run, and it can be read and checked without the rest of the file.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "ndt/lattice.hpp"

namespace landfix::ndt {

/// A symmetric 3 x 3 matrix: xx xy xz yy yz zz.
using Symmetric3f = std::array<float, 6>;

/// One cell's points as a normal distribution. The covariance is kept twice: `wide` with
/// resolution^2 / (count - 1) added along each axis, which widens the basin of convergence, and `sharp` as a
/// scan's points will scatter.
struct alignas(64) Voxel {
  std::array<float, 3> mean_m{};  ///< from the cell's lower corner
  std::uint32_t count = 0;        ///< points that made it
  Symmetric3f wide_1pm2{};        ///< inverse of the wide covariance
  Symmetric3f sharp_1pm2{};       ///< inverse of the sharp covariance
};
static_assert(sizeof(Voxel) == 64);

/// Where the voxels of a block are.
struct BlockEntry {
  std::uint64_t key = 0;
  std::uint64_t occupancy = 0;    ///< a bit a cell; 0 marks an empty place in the table
  std::uint32_t first_voxel = 0;  ///< index of the voxel of the lowest bit
  std::uint32_t reserved = 0;
};
static_assert(sizeof(BlockEntry) == 24);

struct TileBlock {
  std::uint64_t key = 0;
  std::uint64_t occupancy = 0;
};
static_assert(sizeof(TileBlock) == 16);

struct TileEntry {
  std::uint64_t key = 0;  ///< see tile_key
  std::uint32_t first_block = 0;
  std::uint32_t blocks = 0;
  std::uint32_t first_voxel = 0;
  std::uint32_t voxels = 0;
  std::uint32_t checksum = 0;  ///< CRC-32C of its voxels
  std::uint32_t reserved = 0;
};
static_assert(sizeof(TileEntry) == 32);

struct alignas(64) MapHeader {
  std::array<char, 8> magic{};
  std::uint32_t version = 0;
  std::uint32_t byte_order = 0;
  std::uint64_t total_bytes = 0;
  double resolution_m = 1.0;
  std::uint64_t table_size = 0;  ///< entries of the hash table, a power of two
  std::uint64_t voxel_count = 0;
  std::uint64_t block_count = 0;
  std::uint64_t tile_count = 0;
  std::uint64_t point_count = 0;  ///< points that the map was built from
  std::uint32_t longest_probe = 0;
  std::uint32_t index_checksum = 0;      ///< CRC-32C of the hash table and the columns
  std::uint32_t directory_checksum = 0;  ///< CRC-32C of the blocks and tiles
  std::uint32_t header_checksum = 0;     ///< CRC-32C of this header with this field 0
  std::array<std::uint64_t, 5> reserved{};
};
static_assert(sizeof(MapHeader) == 128);

inline constexpr std::array<char, 8> kMapMagic{'L', 'A', 'N', 'D', 'F', 'I', 'X', '\n'};
inline constexpr std::uint32_t kMapVersion = 3;
inline constexpr std::uint32_t kMapByteOrder = 0x01020304;

/// What follows a table of this size begins on a line of its own.
inline constexpr std::size_t kMinTableSize = 8;

/// Blocks of a tile along an axis, as a power of two.
inline constexpr unsigned kTileShift = 2;
inline constexpr std::int32_t kTileCells = 4 << kTileShift;

/// The tile of a block, addressed as blocks are.
[[nodiscard]] constexpr std::uint64_t tile_key(std::uint64_t key) noexcept {
  const Cell corner = block_corner(key);
  constexpr unsigned kShift = 2 + kTileShift;
  return block_key(corner.i >> kShift, corner.j >> kShift, corner.k >> kShift);
}

/// The lower corner of a tile, from its key.
[[nodiscard]] constexpr Cell tile_corner(std::uint64_t key) noexcept {
  const Cell corner = block_corner(key);
  return {corner.i << kTileShift, corner.j << kTileShift, corner.k << kTileShift};
}

/// Floats of one column of means: whole lines, and one more to read beyond the last mean.
[[nodiscard]] constexpr std::uint64_t mean_column_size(std::uint64_t voxel_count) noexcept {
  return (voxel_count + 31) / 16 * 16;
}

/// Entries of the hash table of so many blocks: at most half of them are used.
[[nodiscard]] constexpr std::uint64_t hash_table_size(std::uint64_t block_count) noexcept {
  return std::max<std::uint64_t>(std::bit_ceil(2 * block_count), kMinTableSize);
}

/// Offsets of the parts [bytes].
struct MapLayout {
  explicit constexpr MapLayout(const MapHeader& header) noexcept
      : columns(table + header.table_size * sizeof(BlockEntry)),
        voxels(columns + 3 * mean_column_size(header.voxel_count) * sizeof(float)),
        blocks(voxels + header.voxel_count * sizeof(Voxel)),
        tiles(blocks + header.block_count * sizeof(TileBlock)),
        end(tiles + header.tile_count * sizeof(TileEntry)) {}

  std::uint64_t table = sizeof(MapHeader);
  std::uint64_t columns;
  std::uint64_t voxels;
  std::uint64_t blocks;
  std::uint64_t tiles;
  std::uint64_t end;
};

}  // namespace landfix::ndt
