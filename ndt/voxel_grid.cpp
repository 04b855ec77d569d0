#include "ndt/voxel_grid.hpp"

#include <algorithm>
#include <cmath>

namespace landfix::ndt {
namespace {

/// Puts two zeros between the lowest 21 bits. Three such fields interleaved are a Morton code: order along it
/// keeps neighbours together.
[[nodiscard]] std::uint64_t spread(std::uint64_t bits) noexcept {
  bits = (bits | bits << 32) & 0x001F00000000FFFFU;
  bits = (bits | bits << 16) & 0x001F0000FF0000FFU;
  bits = (bits | bits << 8) & 0x100F00F00F00F00FU;
  bits = (bits | bits << 4) & 0x10C30C30C30C30C3U;
  return (bits | bits << 2) & 0x1249249249249249U;
}

/// A cell beyond this is farther from the sensor than any range and leaf make sense of.
constexpr float kMaxIndex = 1 << 20;

}  // namespace

void VoxelGrid::clear() noexcept {
  size_ = 0;
  dropped_points_ = 0;
  if (++generation_ == 0) {  // after four thousand million sweeps the marks repeat
    std::fill(table_.begin(), table_.end(), Slot{});
    generation_ = 1;
  }
}

void VoxelGrid::add(const Eigen::Vector3f& point_m) noexcept {
  const Eigen::Vector3f scaled = point_m * inverse_leaf_1pm_;
  if (!(std::abs(scaled.x()) < kMaxIndex && std::abs(scaled.y()) < kMaxIndex &&
        std::abs(scaled.z()) < kMaxIndex)) {
    ++dropped_points_;
    return;
  }
  const auto index = [](float value) {
    const auto truncated = static_cast<std::int32_t>(value);
    return static_cast<std::uint64_t>(truncated - (static_cast<float>(truncated) > value ? 1 : 0) +
                                      (1 << 20));
  };
  const std::uint64_t i = index(scaled.x());
  const std::uint64_t j = index(scaled.y());
  const std::uint64_t k = index(scaled.z());
  const std::uint64_t key = (i << 42) | (j << 21) | k;
  const std::size_t mask = table_.size() - 1;
  std::size_t place = hash_key(key) >> hash_shift_;
  for (; table_[place].generation == generation_; place = (place + 1) & mask) {
    if (table_[place].key != key) continue;
    CellSum& cell = cells_[table_[place].index];
    cell.sum_m += point_m;
    ++cell.count;
    return;
  }
  if (size_ == cells_.size()) {
    ++dropped_points_;
    return;
  }
  table_[place] = {.key = key, .generation = generation_, .index = static_cast<std::uint32_t>(size_)};
  cells_[size_++] = {.key = spread(i) << 2 | spread(j) << 1 | spread(k), .sum_m = point_m, .count = 1};
}

std::span<const Eigen::Vector3f> VoxelGrid::finish() noexcept {
  const auto end = cells_.begin() + static_cast<std::ptrdiff_t>(size_);
  std::sort(cells_.begin(), end, [](const CellSum& a, const CellSum& b) { return a.key < b.key; });
  std::transform(cells_.begin(), end, centroids_.begin(), [](const CellSum& cell) -> Eigen::Vector3f {
    return cell.sum_m / static_cast<float>(cell.count);
  });
  return std::span<const Eigen::Vector3f>(centroids_).first(size_);
}

}  // namespace landfix::ndt
