#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

VoxelMap::VoxelMap(std::span<const std::byte> bytes) noexcept
    : header_(reinterpret_cast<const MapHeader*>(bytes.data())),
      resolution_m_(header_->resolution_m),
      hash_shift_(64U - static_cast<unsigned>(std::countr_zero(header_->table_size))),
      longest_probe_(header_->longest_probe) {
  const MapLayout layout(*header_);
  table_ = {reinterpret_cast<const BlockEntry*>(bytes.data() + layout.table), header_->table_size};
  voxels_ = {reinterpret_cast<const Voxel*>(bytes.data() + layout.voxels), header_->voxel_count};
  const auto* const columns = reinterpret_cast<const float*>(bytes.data() + layout.columns);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mean_columns_m_[axis] = columns + axis * mean_column_size(header_->voxel_count);
  }
}

}  // namespace landfix::ndt
