// The map: voxels, each a normal distribution, in one block of memory that is also the map file.
//
//   MapHeader | BlockEntry[table_size] | Voxel[voxel_count] | x[] | y[] | z[] of the means
//
// A flat hash table finds the 4 x 4 x 4 block of a cell, a mask says which of its cells are voxels, and the
// rank of the bit which voxel it is. The means stand a second time in columns, since looking for what is near
// needs nothing else. This is a view: it owns nothing, and reading never allocates.
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
inline constexpr std::uint32_t kMapVersion = 2;
inline constexpr std::uint32_t kMapByteOrder = 0x01020304;

/// Floats of one column of means: whole lines, and one more to read beyond the last mean.
[[nodiscard]] constexpr std::uint64_t mean_column_size(std::uint64_t voxel_count) noexcept {
  return (voxel_count + 31) / 16 * 16;
}

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
  /// The means along one axis, each from the lower corner of its block [m]. 16 floats can be read from any of
  /// them on.
  [[nodiscard]] const float* mean_column_m(std::size_t axis) const noexcept { return mean_columns_m_[axis]; }

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

 private:
  std::span<const BlockEntry> table_;
  std::span<const Voxel> voxels_;
  std::array<const float*, 3> mean_columns_m_{};
  const MapHeader* header_ = nullptr;
  double resolution_m_ = 0.0;
  unsigned hash_shift_ = 63;
  std::uint32_t longest_probe_ = 0;
};

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
