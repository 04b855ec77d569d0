#include "ndt/voxel_grid.hpp"

#include <algorithm>
#include <limits>

namespace landfix::ndt {
namespace {

/// From a slot that is taken to the next: out of its row of neighbours.
constexpr std::uint32_t kProbeStep = 613;

/// From a block's slot to that of the same block for the next ring.
constexpr std::uint32_t kRingStep = 0x9E3779B1U;
/// One less than the key has room for, so that no key is that of kNoRoom.
constexpr std::uint32_t kMostRings = (1U << (kSpareBits - 1)) - 1;

/// Blocks are read in another order than written: each is fetched while so many before it are read.
constexpr std::size_t kBlocksAhead = 6;

/// In units of the leaf; the fourth numbers are nothing.
struct Centroid {
  Eigen::Array4f lower;  ///< corner of the cell
  Eigen::Array4f place;  ///< of the points' mean, from there
};

[[nodiscard]] Centroid centroid_of(std::uint64_t key, std::uint32_t cell, const CellSum& sum) noexcept {
  const auto along = [&](int axis) { return 2 * block_index(key, axis) + (cell >> (2 - axis) & 1U); };
  const std::array<std::uint32_t, 3> lower{along(0), along(1), along(2)};
  const std::uint32_t points = sum[3];
  // What the index adds to each point's coordinate taken off again; below 2^31, as kMostPointsOfCell sees to.
  const auto places = [&](std::size_t axis) {
    return static_cast<std::int32_t>(sum[axis] - points * (lower[axis] << kPlaceBits));
  };
  const auto unbiased = [&](std::size_t axis) { return static_cast<std::int32_t>(lower[axis]) - kIndexBias; };
  const float to_cells = 1.0F / (static_cast<float>(static_cast<std::int32_t>(points)) * (1 << kPlaceBits));
  return {.lower = Eigen::Array4i(unbiased(0), unbiased(1), unbiased(2), 0).cast<float>(),
          .place = to_cells * Eigen::Array4i(places(0), places(1), places(2), 0).cast<float>()};
}

}  // namespace

void VoxelGrid::clear() noexcept {
  for (std::size_t n = 1; n < size_; ++n) table_[slots_[n]] = kNoRoom;
  size_ = 1;
  points_ = 0;
  dropped_points_ = 0;
  pending_size_ = 0;
}

void VoxelGrid::add(std::span<const Eigen::Vector3f> points_m) noexcept {
  // Point by point up to the next whole batch, and after the last.
  const std::size_t first = options_.by_ring
                                ? points_m.size()
                                : std::min((kCellBatch - pending_size_) % kCellBatch, points_m.size());
  for (const Eigen::Vector3f& point_m : points_m.first(first)) add(point_m);
  points_m = points_m.subspan(first);
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
    inside.fill(Eigen::Vector3f::Zero());
    std::size_t count = 0;
    for (std::size_t n = 0; n < size; ++n) {
      if (!(points_m[n].array().abs() * inverse_leaf_1pm < kMostCells).all()) continue;
      inside[count] = points_m[n];
      pending_rings_[count] = pending_rings_[n];
      ++count;
    }
    size = count;
    if (!find_cells(inside, inverse_leaf_1pm, batch_)) return;
  }
  if (options_.by_ring) set_rings(size);
  options_.with_entropy ? sum_batch<true>(size) : sum_batch<false>(size);
}

/// The ring goes where a block's key has no bits.
void VoxelGrid::set_rings(std::size_t size) noexcept {
  static_assert(kSpareBits == 13);
  for (std::size_t n = 0; n < size; ++n) {
    const std::uint32_t ring = pending_rings_[n] & kMostRings;
    batch_.block[n] |= ring;
    batch_.hash[n] += ring * kRingStep;
  }
}

template <bool kWithMoments>
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
    if constexpr (kWithMoments) add_point(moments_[block][batch_.cell[n]], point);
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
  if (options_.with_entropy) moments_[block] = {};
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
    const Centroid at = centroid_of(keys_[block], cell, sum);
    centroids_[n] = (static_cast<float>(leaf_m_) * (at.lower + at.place)).head<3>();
    points += sum[3];
    if (options_.with_entropy) {
      const Eigen::Vector3d mean_place = at.place.head<3>().cast<double>();
      entropies_[n] = entropy_of(moments_[block][cell], mean_place, sum[3], leaf_m_);
    }
  }
  dropped_points_ = points_ - points;
  return std::span(centroids_).first(cells.size());
}

std::span<const std::uint32_t> VoxelGrid::list_cells() noexcept {
  const std::span<const SpatialKey> order = sort_blocks();
  std::size_t count = 0;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const Block& ahead = blocks_[order[std::min(n + kBlocksAhead, order.size() - 1)].index];
    __builtin_prefetch(ahead.data());
    __builtin_prefetch(ahead.data() + 4);
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
    const std::uint64_t code = morton_code(block_index(key, 0) - least[0], block_index(key, 1) - least[1],
                                           block_index(key, 2) - least[2]);
    const std::uint64_t ring = key & kMostRings;
    order[n - 1] = {.code = code << kSpareBits | ring, .index = static_cast<std::uint32_t>(n)};
  }
  sort_by_code(order, std::span(order_).last(order.size()));
  return order;
}

}  // namespace landfix::ndt
