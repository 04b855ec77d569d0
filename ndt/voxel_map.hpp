// The map: voxels, each a normal distribution, in one block of memory that is also the map file. map_file.hpp
// has the layout.
//
// A flat hash table finds the 4 x 4 x 4 block of a cell, a mask says which of its cells are voxels, and the
// rank of the bit which voxel it is. The means stand a second time in columns, since looking for what is near
// needs nothing else. This is a view: it owns nothing, and reading never allocates.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "ndt/lattice.hpp"
#include "ndt/map_layout.hpp"

namespace landfix::ndt {

class VoxelMap {
 public:
  /// A map without voxels.
  VoxelMap() = default;
  /// `bytes`: a map image that has been validated (see map_file.hpp), aligned to 64 bytes, which must outlive
  /// the view.
  explicit VoxelMap(std::span<const std::byte> bytes) noexcept;

  [[nodiscard]] const MapHeader& header() const noexcept { return *header_; }
  [[nodiscard]] double resolution_m() const noexcept { return resolution_m_; }
  [[nodiscard]] std::span<const Voxel> voxels() const noexcept { return voxels_; }
  [[nodiscard]] std::span<const BlockEntry> blocks() const noexcept { return table_; }
  /// The means along one axis, each from the lower corner of its block [m]. 16 floats can be read from any of
  /// them on.
  [[nodiscard]] const float* mean_column_m(std::size_t axis) const noexcept { return mean_columns_m_[axis]; }

  /// The block of a key; null where the map has none.
  [[nodiscard]] const BlockEntry* find_block(std::uint64_t key) const noexcept {
    std::uint64_t place = hash_key(key) >> hash_shift_;
    for (std::uint32_t probe = 0; probe <= longest_probe_; ++probe) {
      const BlockEntry& entry = table_[place];
      if (entry.key == key && entry.occupancy != 0) return &entry;
      if (entry.occupancy == 0) return nullptr;
      place = (place + 1) & (table_.size() - 1);
    }
    return nullptr;
  }

 private:
  static constexpr MapHeader kEmptyHeader{};
  static constexpr std::array<BlockEntry, 2> kEmptyTable{};

  std::span<const BlockEntry> table_ = kEmptyTable;
  std::span<const Voxel> voxels_;
  std::array<const float*, 3> mean_columns_m_{};
  const MapHeader* header_ = &kEmptyHeader;
  double resolution_m_ = 1.0;
  unsigned hash_shift_ = 63;
  std::uint32_t longest_probe_ = 0;
};

/// Calls `visit(const Voxel&, const Eigen::Vector3d& mean_m)` for every voxel, the mean in the frame `map`.
template <class Visit>
void visit_voxels(const VoxelMap& map, Visit&& visit) {
  for (const BlockEntry& block : map.blocks()) {
    const Cell corner = block_corner(block.key);
    std::size_t index = block.first_voxel;
    for (std::uint64_t rest = block.occupancy; rest != 0; rest &= rest - 1, ++index) {
      const Cell in_block = cell_in_block(static_cast<unsigned>(std::countr_zero(rest)));
      const Eigen::Vector3d cell(corner.i + in_block.i, corner.j + in_block.j, corner.k + in_block.k);
      const Voxel& voxel = map.voxels()[index];
      visit(voxel, cell * map.resolution_m() +
                       Eigen::Map<const Eigen::Vector3f>(voxel.mean_m.data()).template cast<double>());
    }
  }
}

}  // namespace landfix::ndt
