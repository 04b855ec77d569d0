// Set-up of the filter: the one place where it allocates.
#include <algorithm>
#include <bit>

#include "ndt/voxel_grid.hpp"

namespace landfix::ndt {

VoxelGrid::VoxelGrid(double leaf_m, std::size_t capacity, const GridOptions& options)
    : leaf_m_(leaf_m),
      inverse_leaf_1pm_(static_cast<float>(1.0 / leaf_m)),
      options_(options),
      keys_(capacity + 1),
      slots_(capacity + 1),
      corners_(capacity + 1),
      sums_(8 * (capacity + 1)),
      moments_(options.with_entropy ? 8 * (capacity + 1) : 0),
      // Where slots are rarely taken already a block is found at the first look.
      table_(std::bit_ceil(4 * std::max<std::size_t>(capacity, 4))),
      order_(2 * capacity),
      centroids_(capacity + 1),
      entropies_(options.with_entropy ? capacity : 0) {
  keys_[kNoRoom] = ~std::uint64_t{0};  // no block's: its lowest bits are not 0
  pending_.fill(Eigen::Vector3f::Zero());
}

}  // namespace landfix::ndt
