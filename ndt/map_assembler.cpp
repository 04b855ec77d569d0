#include "ndt/map_assembler.hpp"

#include <algorithm>
#include <bit>
#include <new>

namespace landfix::ndt {

MapAssembler::MapAssembler(std::span<std::byte> memory, const MapHeader& header) noexcept
    : header_(new (memory.data()) MapHeader(header)) {
  const MapLayout layout(header);
  table_ = {reinterpret_cast<BlockEntry*>(memory.data() + layout.table), header.table_size};
  columns_m_ = reinterpret_cast<float*>(memory.data() + layout.columns);
  voxels_ = {reinterpret_cast<Voxel*>(memory.data() + layout.voxels), header.voxel_count};
  std::fill(table_.begin(), table_.end(), BlockEntry{});
  // What lies behind the means is read along with them.
  const std::uint64_t column_size = mean_column_size(header.voxel_count);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::fill(columns_m_ + axis * column_size + header.voxel_count, columns_m_ + (axis + 1) * column_size,
              0.0F);
  }
}

void MapAssembler::add(const TileBlock& block, std::uint32_t first_voxel) noexcept {
  const unsigned shift = 64U - static_cast<unsigned>(std::countr_zero(table_.size()));
  std::uint64_t place = hash_key(block.key) >> shift;
  std::uint32_t probe = 0;
  for (; table_[place].occupancy != 0; ++probe) place = (place + 1) & (table_.size() - 1);
  table_[place] = {.key = block.key, .occupancy = block.occupancy, .first_voxel = first_voxel};
  header_->longest_probe = std::max(header_->longest_probe, probe);

  const std::uint64_t column_size = mean_column_size(header_->voxel_count);
  std::size_t index = first_voxel;
  for (std::uint64_t rest = block.occupancy; rest != 0; rest &= rest - 1, ++index) {
    const Cell cell = cell_in_block(static_cast<unsigned>(std::countr_zero(rest)));
    const std::array<std::int32_t, 3> lower{cell.i, cell.j, cell.k};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns_m_[axis * column_size + index] =
          static_cast<float>(lower[axis] * header_->resolution_m) + voxels_[index].mean_m[axis];
    }
  }
}

}  // namespace landfix::ndt
