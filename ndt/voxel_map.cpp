#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

VoxelMap::VoxelMap(std::span<const std::byte> bytes) noexcept
    : header_(reinterpret_cast<const MapHeader*>(bytes.data())),
      resolution_m_(header_->resolution_m),
      hash_shift_(64U - static_cast<unsigned>(std::countr_zero(header_->table_size))),
      longest_probe_(header_->longest_probe) {
  const auto* const table = reinterpret_cast<const BlockEntry*>(bytes.data() + sizeof(MapHeader));
  table_ = {table, header_->table_size};
  // The table's size is a power of two of at least 8, so the voxels begin on a line of their own.
  voxels_ = {reinterpret_cast<const Voxel*>(table + header_->table_size), header_->voxel_count};
  const auto* const columns = reinterpret_cast<const float*>(voxels_.data() + voxels_.size());
  const std::size_t column_size = mean_column_size(header_->voxel_count);
  for (std::size_t axis = 0; axis < 3; ++axis) mean_columns_m_[axis] = columns + axis * column_size;
}

}  // namespace landfix::ndt
