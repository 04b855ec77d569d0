// Finds the voxels near the points of a group: most of the time of matching, so compiled for every
// instruction set as the inner loop is (pair_kernel.hpp).
#pragma once

#include <array>
#include <cstddef>

#include "ndt/pair_groups.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// The points of a group, each in the frame `vehicle` from the group's centre, and in the frame `map` from
/// the lower corner of the cell `origin`.
struct GroupPoints {
  std::size_t count = 0;
  Cell origin;
  float radius_m = 0.0F;  ///< what is near, less than two resolutions
  std::array<std::array<float, 3>, kGroupPoints> point_m{};
  std::array<std::array<float, 3>, kGroupPoints> position_m{};
};

struct LookUp {
  std::size_t pairs = 0;
  std::size_t dropped = 0;  ///< did not fit
};

/// Fills all columns but the covariances.
[[nodiscard]] LookUp look_up_pairs(const VoxelMap& map, const GroupPoints& points,
                                   PairColumns& columns) noexcept;

}  // namespace landfix::ndt
