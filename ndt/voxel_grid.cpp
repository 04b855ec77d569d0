#include "ndt/voxel_grid.hpp"

#include <algorithm>
#include <limits>

namespace landfix::ndt {
namespace {

/// From a slot that is taken to the next: out of its row of neighbours.
constexpr std::uint32_t kProbeStep = 613;

/// Blocks are read in another order than written: each is fetched while so many before it are read.
constexpr std::size_t kBlocksAhead = 6;

}  // namespace

void VoxelGrid::clear() noexcept {
  for (std::size_t n = 1; n < size_; ++n) table_[slots_[n]] = kNoRoom;
  size_ = 1;
  points_ = 0;
  dropped_points_ = 0;
  pending_size_ = 0;
}

void VoxelGrid::add(std::span<const Eigen::Vector3f> points_m) noexcept {
  if (pending_size_ != 0) {
    const std::size_t room = std::min(kCellBatch - pending_size_, points_m.size());
    for (const Eigen::Vector3f& point_m : points_m.first(room)) add(point_m);
    points_m = points_m.subspan(room);
  }
  for (; points_m.size() >= kCellBatch; points_m = points_m.subspan(kCellBatch)) {
    add_batch(points_m.first<kCellBatch>(), kCellBatch);
  }
  for (const Eigen::Vector3f& point_m : points_m) add(point_m);
}

void VoxelGrid::add_pending() noexcept {
  add_batch(pending_, pending_size_);
  pending_size_ = 0;
}

void VoxelGrid::add_batch(std::span<const Eigen::Vector3f, kCellBatch> points_m, std::size_t size) noexcept {
  points_ += size;
  const auto inverse_leaf_1pm = static_cast<float>(1.0 / leaf_m_);
  if (!find_cells(points_m, inverse_leaf_1pm, batch_)) {
    // Seldom: once more, without those that have no cell.
    Points inside;
    const auto end = std::copy_if(points_m.begin(), points_m.begin() + static_cast<std::ptrdiff_t>(size),
                                  inside.begin(), [inverse_leaf_1pm](const Eigen::Vector3f& point_m) {
                                    return (point_m.array().abs() * inverse_leaf_1pm < kMostCells).all();
                                  });
    std::fill(end, inside.end(), Eigen::Vector3f::Zero());
    size = static_cast<std::size_t>(end - inside.begin());
    if (!find_cells(inside, inverse_leaf_1pm, batch_)) return;
  }
  sum_batch(size);
}

void VoxelGrid::sum_batch(std::size_t size) noexcept {
  const std::size_t mask = table_.size() - 1;
  for (std::size_t n = 0; n < size; ++n) {
    std::uint32_t block = table_[batch_.hash[n] & mask];
    if (keys_[block] != batch_.block[n]) [[unlikely]] {
      block = find_or_open(batch_.block[n], batch_.hash[n]);
    }
    CellSum& sum = blocks_[block][batch_.cell[n]];
    const CellSum point = batch_.point[n];  // a copy, so that the four are added at once
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += point[i];
  }
}

std::uint32_t VoxelGrid::find_or_open(std::uint64_t key, std::uint32_t hash) noexcept {
  const auto mask = static_cast<std::uint32_t>(table_.size() - 1);
  std::uint32_t slot = hash & mask;
  for (; table_[slot] != kNoRoom; slot = (slot + kProbeStep) & mask) {
    if (keys_[table_[slot]] == key) return table_[slot];
  }
  if (size_ == keys_.size()) return kNoRoom;
  const auto block = static_cast<std::uint32_t>(size_++);
  table_[slot] = block;
  slots_[block] = slot;
  keys_[block] = key;
  blocks_[block] = {};
  return block;
}

std::span<Eigen::Vector3f> VoxelGrid::finish() noexcept {
  add_pending();
  const std::span<const std::uint32_t> cells = list_cells();
  std::size_t points = 0;
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const std::uint32_t block = cells[n] / 8;
    const std::uint32_t cell = cells[n] % 8;
    const CellSum& sum = blocks_[block][cell];
    centroids_[n] = centroid(keys_[block], cell, sum);
    points += sum[3];
  }
  dropped_points_ = points_ - points;
  return std::span(centroids_).first(cells.size());
}

std::span<const std::uint32_t> VoxelGrid::list_cells() noexcept {
  const std::span<const SpatialKey> order = sort_blocks();
  std::size_t count = 0;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const Block& ahead = blocks_[order[std::min(n + kBlocksAhead, order.size() - 1)].index];
    __builtin_prefetch(&ahead[0]);
    __builtin_prefetch(&ahead[4]);
    const std::uint32_t block = order[n].index;
    for (std::uint32_t cell = 0; cell < 8; ++cell) {
      // Without a branch, as none would foresee which cells are empty.
      cells_[count] = 8 * block + cell;
      count += blocks_[block][cell][3] - 1 < kMostPointsOfCell ? 1U : 0U;
    }
  }
  return std::span<const std::uint32_t>(cells_).first(std::min(count, centroids_.size()));
}

std::span<const SpatialKey> VoxelGrid::sort_blocks() noexcept {
  // Counted from the least, the indices have few bits to be sorted by.
  std::array<std::uint32_t, 3> least;
  least.fill(std::numeric_limits<std::uint32_t>::max());
  for (std::size_t n = 1; n < size_; ++n) {
    for (int axis = 0; axis < 3; ++axis) {
      std::uint32_t& at_axis = least[static_cast<std::size_t>(axis)];
      at_axis = std::min(at_axis, block_index(keys_[n], axis));
    }
  }
  const std::span<SpatialKey> order = std::span(order_).first(size_ - 1);
  for (std::size_t n = 1; n < size_; ++n) {
    const std::uint64_t key = keys_[n];
    order[n - 1] = {.code = morton_code(block_index(key, 0) - least[0], block_index(key, 1) - least[1],
                                        block_index(key, 2) - least[2]),
                    .index = static_cast<std::uint32_t>(n)};
  }
  sort_by_code(order, std::span(order_).last(order.size()));
  return order;
}

Eigen::Vector3f VoxelGrid::centroid(std::uint64_t key, std::uint32_t cell,
                                    const CellSum& sum) const noexcept {
  const std::uint32_t points = sum[3];
  const double to_cells = 1.0 / (static_cast<double>(points) * (1 << kPlaceBits));
  const auto along = [&](int axis) {
    const std::uint32_t index = 2 * block_index(key, axis) + (cell >> (2 - axis) & 1U);
    const std::uint32_t places = sum[static_cast<std::size_t>(axis)] - points * (index << kPlaceBits);
    const double cells = static_cast<std::int32_t>(index) - kIndexBias + places * to_cells;
    return static_cast<float>(cells * leaf_m_);
  };
  return {along(0), along(1), along(2)};
}

}  // namespace landfix::ndt
