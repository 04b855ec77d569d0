// Set-up of the filter: the one place where it allocates.
#include <algorithm>
#include <bit>

#include "ndt/voxel_grid.hpp"

namespace landfix::ndt {

VoxelGrid::VoxelGrid(double leaf_m, std::size_t capacity)
    : inverse_leaf_1pm_(1.0F / static_cast<float>(leaf_m)),
      table_(std::bit_ceil(2 * std::max<std::size_t>(capacity, 4))),
      cells_(capacity),
      centroids_(capacity) {
  hash_shift_ = 64U - static_cast<unsigned>(std::countr_zero(table_.size()));
}

}  // namespace landfix::ndt
