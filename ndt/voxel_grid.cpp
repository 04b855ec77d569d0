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

/// So many points are found their blocks at once and then added, from all over the batch: neighbours in it
/// often share a cell, and a sum is slow to read just after it is written.
constexpr std::size_t kTogether = 8;
constexpr std::size_t kStride = kCellBatch / kTogether;

/// Blocks are read in another order than written: each is fetched while so many before it are read.
constexpr std::size_t kBlocksAhead = 6;

/// In units of the leaf; the fourth numbers are nothing.
struct Centroid {
  Eigen::Array4f lower;  ///< corner of the cell
  Eigen::Array4f place;  ///< of the points' mean, from there
};

[[nodiscard]] Centroid centroid_of(std::uint64_t key, std::uint32_t cell, const CellSum& sum) noexcept {
  const auto along = [&](int axis) {
    return static_cast<std::int32_t>(2 * block_index(key, axis) + (cell >> (2 - axis) & 1U)) - kIndexBias;
  };
  const auto to_cells = 1.0F / (static_cast<float>(sum[3]) * (1 << kPlaceBits));
  return {.lower = Eigen::Array4i(along(0), along(1), along(2), 0).cast<float>(),
          .place = to_cells * sum.cast<float>()};
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
  const auto slot_mask = static_cast<std::uint32_t>(table_.size() - 1);
  if (!find_cells(points_m, inverse_leaf_1pm_, slot_mask, batch_)) {
    // Seldom: once more, without those that have no cell.
    Points inside;
    inside.fill(Eigen::Vector3f::Zero());
    std::size_t count = 0;
    for (std::size_t n = 0; n < size; ++n) {
      const Eigen::Array3f cells = points_m[n] * inverse_leaf_1pm_;
      if (!(cells >= -kIndexBias && cells < kIndexBias).all()) continue;
      inside[count] = points_m[n];
      pending_rings_[count] = pending_rings_[n];
      ++count;
    }
    size = count;
    if (!find_cells(inside, inverse_leaf_1pm_, slot_mask, batch_)) return;
  }
  if (size == 0) return;
  if (options_.by_ring) set_rings();
  if (size != kCellBatch) blank_from(size);
  options_.with_entropy ? sum_batch<true>() : sum_batch<false>();
}

/// The ring goes where a block's key has no bits.
void VoxelGrid::set_rings() noexcept {
  static_assert(kSpareBits == 13);
  const auto slot_mask = static_cast<std::uint32_t>(table_.size() - 1);
  for (std::size_t n = 0; n < kCellBatch; ++n) {
    const std::uint32_t ring = pending_rings_[n] & kMostRings;
    batch_.key[n] |= ring;
    batch_.slot[n] = (batch_.slot[n] + ring * kRingStep) & slot_mask;
  }
}

/// What is no point is no more of the first one's cell.
void VoxelGrid::blank_from(std::size_t size) noexcept {
  for (std::size_t n = size; n < kCellBatch; ++n) {
    batch_.key[n] = batch_.key[0];
    batch_.slot[n] = batch_.slot[0];
    batch_.cell[n] = batch_.cell[0];
    batch_.point[n].setZero();
  }
}

template <bool kWithMoments>
void VoxelGrid::sum_batch() noexcept {
  CellSum* const sums = sums_.data();  // else it would be read again after each sum
  for (std::size_t first = 0; first < kStride; ++first) {
    std::array<std::uint32_t, kTogether> cells;
    for (std::size_t i = 0; i < kTogether; ++i) {
      const std::size_t n = first + i * kStride;
      std::uint32_t block = table_[batch_.slot[n]];
      if (keys_[block] != batch_.key[n]) [[unlikely]]
        block = find_or_open(n);
      cells[i] = 8 * block + batch_.cell[n];
    }
    for (std::size_t i = 0; i < kTogether; ++i) {
      const CellSum& point = batch_.point[first + i * kStride];
      sums[cells[i]] += point;
      if constexpr (kWithMoments) add_point(moments_[cells[i]], point);
    }
  }
}

std::uint32_t VoxelGrid::find_or_open(std::size_t n) noexcept {
  const std::uint64_t key = batch_.key[n];
  const auto mask = static_cast<std::uint32_t>(table_.size() - 1);
  std::uint32_t slot = batch_.slot[n];
  for (; table_[slot] != kNoRoom; slot = (slot + kProbeStep) & mask) {
    if (keys_[table_[slot]] == key) return table_[slot];
  }
  if (size_ == keys_.size()) return kNoRoom;
  const auto block = static_cast<std::uint32_t>(size_++);
  table_[slot] = block;
  slots_[block] = slot;
  keys_[block] = key;
  std::fill_n(sums_.begin() + 8 * block, 8, CellSum::Zero());
  if (options_.with_entropy) std::fill_n(moments_.begin() + 8 * block, 8, CellMoments{});
  return block;
}

std::span<Eigen::Vector3f> VoxelGrid::finish() noexcept {
  add_pending();
  const std::span<const std::uint32_t> cells = list_cells();
  std::size_t points = 0;
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const CellSum& sum = sums_[cells[n]];
    const Centroid at = centroid_of(keys_[cells[n] / 8], cells[n] % 8, sum);
    centroids_[n] = (static_cast<float>(leaf_m_) * (at.lower + at.place)).head<3>();
    points += static_cast<std::size_t>(sum[3]);
    if (options_.with_entropy) {
      const Eigen::Vector3d mean_place = at.place.head<3>().cast<double>();
      entropies_[n] = entropy_of(moments_[cells[n]], mean_place, static_cast<std::uint32_t>(sum[3]), leaf_m_);
    }
  }
  dropped_points_ = points_ - points;
  return std::span(centroids_).first(cells.size());
}

std::span<const std::uint32_t> VoxelGrid::list_cells() noexcept {
  const std::span<const SpatialKey> order = sort_blocks();
  std::size_t count = 0;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const CellSum* const ahead = &sums_[8 * order[std::min(n + kBlocksAhead, order.size() - 1)].index];
    __builtin_prefetch(ahead);
    __builtin_prefetch(ahead + 4);
    for (std::uint32_t cell = 8 * order[n].index; cell < 8 * order[n].index + 8; ++cell) {
      // Without a branch, as none would foresee which cells are empty.
      cells_[count] = cell;
      count += sums_[cell][3] > 0 && sums_[cell][3] <= kMostPointsOfCell ? 1U : 0U;
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
