// A place in the middle of a map, for what has to begin somewhere before the vehicle's own is known.
#pragma once

#include <limits>

#include <Eigen/Core>

#include "ndt/lattice.hpp"

namespace landfix::ndt {

/// The centre of the block that is nearest to the mean of all; the lattice's origin where there is none.
/// `blocks`: BlockEntry or TileBlock.
template <class Blocks>
[[nodiscard]] Eigen::Vector3d middle_m(const Blocks& blocks, double resolution_m) noexcept {
  const auto centre_m = [resolution_m](std::uint64_t key) -> Eigen::Vector3d {
    const Cell corner = block_corner(key);
    return resolution_m * Eigen::Vector3d(corner.i + 2, corner.j + 2, corner.k + 2);
  };
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const auto& block : blocks) {
    if (block.occupancy == 0) continue;
    sum_m += centre_m(block.key);
    count += 1.0;
  }
  Eigen::Vector3d nearest_m = Eigen::Vector3d::Zero();
  double least_m2 = std::numeric_limits<double>::infinity();
  for (const auto& block : blocks) {
    if (block.occupancy == 0) continue;
    const double away_m2 = (centre_m(block.key) - sum_m / count).squaredNorm();
    if (away_m2 >= least_m2) continue;
    least_m2 = away_m2;
    nearest_m = centre_m(block.key);
  }
  return nearest_m;
}

}  // namespace landfix::ndt
