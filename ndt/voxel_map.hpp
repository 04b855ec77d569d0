// The map: voxels, each a normal distribution, in one block of memory that is also the map file.
//
//   MapHeader | BlockEntry[table_size] | Voxel[voxel_count]
//
// A flat hash table finds the 4 x 4 x 4 block of a cell, a mask says which of its cells are voxels, and the
// rank of the bit which voxel it is. This is a view: it owns nothing, and reading never allocates.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "ndt/lattice.hpp"

namespace landfix::ndt {

/// A symmetric 3 x 3 matrix: xx xy xz yy yz zz.
using Symmetric3f = std::array<float, 6>;

/// One cell's points as a normal distribution. The covariance is kept twice: `sharp` as estimated, and `wide`
/// with resolution^2 / (count - 1) added along each axis, which widens the basin of convergence.
struct alignas(64) Voxel {
  std::array<float, 3> mean_m{};  ///< from the cell's lower corner
  std::uint32_t count = 0;        ///< points that made it
  Symmetric3f wide_1pm2{};        ///< inverse of the wide covariance
  Symmetric3f sharp_1pm2{};       ///< inverse of the covariance
};
static_assert(sizeof(Voxel) == 64);

/// Where the voxels of a block are.
struct BlockEntry {
  std::uint64_t key = 0;
  std::uint64_t occupancy = 0;    ///< a bit a cell; 0 marks an empty place in the table
  std::uint32_t first_voxel = 0;  ///< index of the voxel of the lowest bit
  std::uint32_t reserved = 0;
};
static_assert(sizeof(BlockEntry) == 24);

struct alignas(64) MapHeader {
  std::array<char, 8> magic{};
  std::uint32_t version = 0;
  std::uint32_t byte_order = 0;
  std::uint64_t total_bytes = 0;
  double resolution_m = 0.0;
  std::uint64_t table_size = 0;  ///< entries of the hash table, a power of two
  std::uint64_t voxel_count = 0;
  std::uint64_t point_count = 0;  ///< points that the map was built from
  std::uint32_t longest_probe = 0;
  std::uint32_t checksum = 0;  ///< CRC-32C of all bytes with this field 0
};
static_assert(sizeof(MapHeader) == 64);

inline constexpr std::array<char, 8> kMapMagic{'L', 'A', 'N', 'D', 'F', 'I', 'X', '\n'};
inline constexpr std::uint32_t kMapVersion = 1;
inline constexpr std::uint32_t kMapByteOrder = 0x01020304;

class VoxelMap {
 public:
  VoxelMap() = default;
  /// `bytes`: a map image that has been validated (see map_file.hpp), aligned to 64 bytes, which must outlive
  /// the view.
  explicit VoxelMap(std::span<const std::byte> bytes) noexcept;

  [[nodiscard]] const MapHeader& header() const noexcept { return *header_; }
  [[nodiscard]] double resolution_m() const noexcept { return resolution_m_; }
  [[nodiscard]] std::span<const Voxel> voxels() const noexcept { return voxels_; }
  [[nodiscard]] std::span<const BlockEntry> blocks() const noexcept { return table_; }

  /// The block of a key; null where the map has none.
  [[nodiscard]] const BlockEntry* find_block(std::uint64_t key) const noexcept {
    std::uint64_t place = hash_key(key) >> hash_shift_;
    for (std::uint32_t probe = 0; probe <= longest_probe_; ++probe) {
      const BlockEntry& entry = table_[place];
      if (entry.key == key && entry.occupancy != 0) return &entry;
      if (entry.occupancy == 0) return nullptr;
      place = (place + 1) & (table_.size() - 1);
    }
    return nullptr;
  }

  /// Calls `visit(const Voxel&, const Eigen::Vector3f& difference_m)` for every voxel whose mean lies within
  /// one resolution of the point; the difference is point - mean. A mean lies in its own cell, so the 27
  /// cells around the point hold them all.
  template <class Visit>
  void visit_near(const LatticePoint& point, Visit&& visit) const noexcept;

 private:
  std::span<const BlockEntry> table_;
  std::span<const Voxel> voxels_;
  const MapHeader* header_ = nullptr;
  double resolution_m_ = 0.0;
  unsigned hash_shift_ = 63;
  std::uint32_t longest_probe_ = 0;
};

namespace detail {

/// Cells of a block, along one axis, that lie in [first, last] (block coordinates, may reach beyond 0..3), as
/// a mask over all its 64 cells.
struct AxisMasks {
  std::uint64_t pattern;  ///< the cells of index 0 along the axis
  unsigned stride;        ///< bits from one index to the next
};
inline constexpr std::array<AxisMasks, 3> kAxisMasks{
    {{0x1111111111111111U, 1}, {0x000F000F000F000FU, 4}, {0xFFFFU, 16}}};

[[nodiscard]] constexpr std::uint64_t slab(const AxisMasks& axis, std::int32_t first,
                                           std::int32_t last) noexcept {
  std::uint64_t mask = 0;
  for (std::int32_t i = first < 0 ? 0 : first; i <= (last > 3 ? 3 : last); ++i) {
    mask |= axis.pattern << (axis.stride * static_cast<unsigned>(i));
  }
  return mask;
}

/// slab(axis, c - 1, c + 1) for c = -1..4: the cell of the point relative to the block's corner.
inline constexpr auto kNeighbourSlabs = [] {
  std::array<std::array<std::uint64_t, 6>, 3> slabs{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::int32_t c = -1; c <= 4; ++c) {
      slabs[axis][static_cast<std::size_t>(c + 1)] = slab(kAxisMasks[axis], c - 1, c + 1);
    }
  }
  return slabs;
}();

}  // namespace detail

template <class Visit>
void VoxelMap::visit_near(const LatticePoint& point, Visit&& visit) const noexcept {
  if (!point.inside) return;
  const auto resolution = static_cast<float>(resolution_m_);
  const float radius_m2 = resolution * resolution;
  const Cell& c = point.cell;
  for (std::int32_t bk = (c.k - 1) >> 2; bk <= (c.k + 1) >> 2; ++bk) {
    for (std::int32_t bj = (c.j - 1) >> 2; bj <= (c.j + 1) >> 2; ++bj) {
      for (std::int32_t bi = (c.i - 1) >> 2; bi <= (c.i + 1) >> 2; ++bi) {
        const BlockEntry* const block = find_block(block_key(bi, bj, bk));
        if (block == nullptr) continue;
        const Cell local{c.i - 4 * bi, c.j - 4 * bj, c.k - 4 * bk};
        std::uint64_t near = block->occupancy &
                             detail::kNeighbourSlabs[0][static_cast<std::size_t>(local.i + 1)] &
                             detail::kNeighbourSlabs[1][static_cast<std::size_t>(local.j + 1)] &
                             detail::kNeighbourSlabs[2][static_cast<std::size_t>(local.k + 1)];
        for (; near != 0; near &= near - 1) {
          const int bit = std::countr_zero(near);
          const std::uint64_t below = (std::uint64_t{1} << bit) - 1;
          const Voxel& voxel = voxels_[block->first_voxel +
                                       static_cast<std::uint32_t>(std::popcount(block->occupancy & below))];
          const Eigen::Vector3f cells(static_cast<float>(local.i - (bit & 3)),
                                      static_cast<float>(local.j - ((bit >> 2) & 3)),
                                      static_cast<float>(local.k - (bit >> 4)));
          const Eigen::Vector3f difference_m =
              cells * resolution + point.offset_m - Eigen::Map<const Eigen::Vector3f>(voxel.mean_m.data());
          if (difference_m.squaredNorm() <= radius_m2) visit(voxel, difference_m);
        }
      }
    }
  }
}

/// Calls `visit(const Voxel&, const Eigen::Vector3d& mean_m)` for every voxel, the mean in the frame `map`.
template <class Visit>
void visit_voxels(const VoxelMap& map, Visit&& visit) {
  for (const BlockEntry& block : map.blocks()) {
    const Cell corner = block_corner(block.key);
    std::size_t index = block.first_voxel;
    for (std::uint64_t rest = block.occupancy; rest != 0; rest &= rest - 1, ++index) {
      const int bit = std::countr_zero(rest);
      const Eigen::Vector3d cell(corner.i + (bit & 3), corner.j + ((bit >> 2) & 3), corner.k + (bit >> 4));
      const Voxel& voxel = map.voxels()[index];
      visit(voxel, cell * map.resolution_m() +
                       Eigen::Map<const Eigen::Vector3f>(voxel.mean_m.data()).template cast<double>());
    }
  }
}

}  // namespace landfix::ndt
