#include "ndt/voxel_grid.hpp"

#include <algorithm>

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

/// i, j, k of a block's cells, from its lowest.
alignas(16) constexpr auto kCellsOfBlock = [] {
  std::array<std::array<std::int32_t, 4>, 8> cells{};
  for (std::int32_t cell = 0; cell < 8; ++cell) {
    cells[static_cast<std::size_t>(cell)] = {cell >> 2, cell >> 1 & 1, cell & 1, 0};
  }
  return cells;
}();

[[nodiscard]] Eigen::Array4i lowest_cell_of(std::uint64_t key) noexcept {
  const auto along = [key](int axis) {
    return 2 * static_cast<std::int32_t>(block_index(key, axis)) - kIndexBias;
  };
  return {along(0), along(1), along(2), 0};
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
    batch_.place[n] = {};
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
      const Place& place = batch_.place[first + i * kStride];
      sums[cells[i]] += widened(place);
      if constexpr (kWithMoments) add_point(moments_[cells[i]], place);
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
  corners_[block] = lowest_cell_of(key);
  const std::size_t cell = std::size_t{8} * block;
  std::fill_n(&sums_[cell], 8, CellSum::Zero());
  if (options_.with_entropy) std::fill_n(&moments_[cell], 8, CellMoments{});
  return block;
}

inline void VoxelGrid::average(std::uint32_t cell, std::size_t n) noexcept {
  const CellSum& sum = sums_[cell];
  const Eigen::Array4i from_corner =
      Eigen::Map<const Eigen::Array4i, Eigen::Aligned16>(kCellsOfBlock[cell % 8].data());
  const Eigen::Array4f lower = (corners_[cell / 8] + from_corner).cast<float>();
  const Eigen::Array4f place = sum.cast<float>() * (1.0F / (static_cast<float>(sum[3]) * (1 << kPlaceBits)));
  // Four numbers at once: the next centroid is written over the fourth.
  Eigen::Map<Eigen::Array4f>(centroids_[n].data()) = static_cast<float>(leaf_m_) * (lower + place);
  if (options_.with_entropy) {
    const Eigen::Vector3d mean_place = place.head<3>().cast<double>();
    entropies_[n] = entropy_of(moments_[cell], mean_place, static_cast<std::uint32_t>(sum[3]), leaf_m_);
  }
}

std::span<Eigen::Vector3f> VoxelGrid::finish() noexcept {
  add_pending();
  std::size_t count = 0;
  std::size_t points = 0;
  for (std::span<const SpatialKey> rest = sort_blocks(); !rest.empty();
       rest = rest.subspan(std::min(kBlocksAtOnce, rest.size()))) {
    const std::span<const std::uint32_t> cells = list_cells(rest);
    for (const std::uint32_t cell : cells.first(std::min(cells.size(), centroids_.size() - 1 - count))) {
      average(cell, count++);
      points += static_cast<std::size_t>(sums_[cell][3]);
    }
  }
  dropped_points_ = points_ - points;
  return std::span(centroids_).first(count);
}

/// Those with points of the first kBlocksAtOnce.
std::span<const std::uint32_t> VoxelGrid::list_cells(std::span<const SpatialKey> order) noexcept {
  std::size_t count = 0;
  for (std::size_t n = 0; n < std::min(kBlocksAtOnce, order.size()); ++n) {
    // Blocks are read in another order than written: those of the next call are fetched.
    const CellSum* const ahead =
        &sums_[std::size_t{8} * order[std::min(n + kBlocksAtOnce, order.size() - 1)].index];
    __builtin_prefetch(ahead);
    __builtin_prefetch(ahead + 4);
    for (std::uint32_t cell = 8 * order[n].index; cell < 8 * order[n].index + 8; ++cell) {
      // Without a branch, as none would foresee which cells are empty.
      listed_[count] = cell;
      count += static_cast<std::uint32_t>(sums_[cell][3] - 1) < std::uint32_t{kMostPointsOfCell} ? 1U : 0U;
    }
  }
  return std::span<const std::uint32_t>(listed_).first(count);
}

std::span<const SpatialKey> VoxelGrid::sort_blocks() noexcept {
  const std::span<const Eigen::Array4i> corners = std::span(corners_).subspan(1, size_ - 1);
  // Counted from the least, the indices have few bits to be sorted by.
  Eigen::Array4i least = Eigen::Array4i::Constant(kIndexBias);
  for (const Eigen::Array4i& corner : corners) least = least.min(corner);
  const std::span<SpatialKey> order = std::span(order_).first(corners.size());
  for (std::size_t n = 0; n < corners.size(); ++n) {
    const Eigen::Array4i at = corners[n] - least;
    const auto along = [&](int axis) { return static_cast<std::uint64_t>(at[axis]) / 2; };
    const std::uint64_t ring = keys_[n + 1] & kMostRings;
    order[n] = {.code = morton_code(along(0), along(1), along(2)) << kSpareBits | ring,
                .index = static_cast<std::uint32_t>(n + 1)};
  }
  sort_by_code(order, std::span(order_).last(order.size()));
  return order;
}

}  // namespace landfix::ndt
