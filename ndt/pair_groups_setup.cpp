#include <algorithm>
#include <numbers>

#include "ndt/pair_groups.hpp"

namespace landfix::ndt {
namespace {

/// Voxels within reach where every cell has one: the sphere's volume, and a seventh for where it is fullest.
[[nodiscard]] double voxels_within(const Reach& reach) noexcept {
  const double radius = reach.pair + reach.margin;
  return 8.0 / 7.0 * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

}  // namespace

PairGroups::PairGroups(std::size_t max_points, const Reach& reach)
    : reach_(reach),
      points_per_group_(std::min(kGroupPoints, static_cast<std::size_t>(kGroupPairs / voxels_within(reach)))),
      points_m_(max_points),
      groups_((max_points + points_per_group_ - 1) / points_per_group_),
      columns_(groups_.size()) {}

}  // namespace landfix::ndt
