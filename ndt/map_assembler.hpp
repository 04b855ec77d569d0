// Fills the part of a map image that is searched: hash table and columns of means, block by block. Allocates
// nothing: the image lies in memory that the caller has.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "ndt/map_layout.hpp"

namespace landfix::ndt {

class MapAssembler {
 public:
  /// `memory`: aligned to 64 bytes and of MapLayout::end bytes at least. `header`: resolution, table size and
  /// counts are set; it is copied to where it belongs.
  MapAssembler(std::span<std::byte> memory, const MapHeader& header) noexcept;

  [[nodiscard]] MapHeader& header() noexcept { return *header_; }
  /// To be written before their block is added. Those that no block names are never read.
  [[nodiscard]] std::span<Voxel> voxels() noexcept { return voxels_; }
  /// A block's key comes once.
  void add(const TileBlock& block, std::uint32_t first_voxel) noexcept;

 private:
  MapHeader* header_;
  std::span<BlockEntry> table_;
  float* columns_m_;
  std::span<Voxel> voxels_;
};

}  // namespace landfix::ndt
