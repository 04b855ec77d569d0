#include "platform/map_window.hpp"

#include "ndt/lattice.hpp"

namespace landfix::platform {

ndt::VoxelMap MapWindow::newest(const Eigen::Vector3d& place_m) noexcept {
  const Eigen::Vector3d cells = place_m / resolution_m();
  if (ndt::has_cell(cells)) {
    place_.store(ndt::block_key(ndt::cell_of(cells)), std::memory_order_relaxed);
  }
  return ndt::VoxelMap(images_[hand_over_.newest()].bytes());
}

}  // namespace landfix::platform
