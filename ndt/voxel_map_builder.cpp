#include "ndt/voxel_map_builder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>
#include <optional>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "ndt/map_file.hpp"

namespace landfix::ndt {
namespace {

/// A voxel is at least a tenth as thick as it is long (Magnusson): its inverse stays bounded.
constexpr double kSmallestEigenvalueRatio = 0.01;
/// Points closer together than this have no shape.
constexpr double kSmallestExtent_m = 1e-4;

[[nodiscard]] std::uint64_t hash_cell(const Cell& cell) noexcept {
  const auto bits = [](std::int32_t index) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(index));
  };
  return hash_key(bits(cell.i) * 0x8DA6B343U ^ bits(cell.j) * 0xD8163841U ^ (bits(cell.k) << 32));
}

[[nodiscard]] Symmetric3f inverse_of_bounded(const Eigen::Matrix3d& covariance_m2) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance_m2);
  const Eigen::Vector3d bounded =
      eigen.eigenvalues().cwiseMax(kSmallestEigenvalueRatio * eigen.eigenvalues().maxCoeff());
  const Eigen::Matrix3f inverse =
      (eigen.eigenvectors() * bounded.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose())
          .cast<float>();
  return {inverse(0, 0), inverse(0, 1), inverse(0, 2), inverse(1, 1), inverse(1, 2), inverse(2, 2)};
}

/// Interleaves the bits of a block's coordinates, so that neighbours in space are neighbours in memory.
[[nodiscard]] std::uint64_t morton(std::uint64_t key) noexcept {
  constexpr std::uint64_t kSignToFront = 1U << 20;
  std::uint64_t code = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const std::uint64_t field = ((key >> (21 * axis)) & ((1U << 21) - 1)) ^ kSignToFront;
    for (unsigned bit = 0; bit < 21; ++bit) code |= ((field >> bit) & 1) << (3 * bit + axis);
  }
  return code;
}

struct PlacedVoxel {
  std::uint64_t key;
  std::uint64_t order;
  unsigned bit;
  Voxel voxel;
};

/// Fills the hash table; returns the longest probe.
std::uint32_t insert(std::span<BlockEntry> table, const BlockEntry& entry) noexcept {
  const unsigned shift = 64U - static_cast<unsigned>(std::countr_zero(table.size()));
  std::uint64_t place = hash_key(entry.key) >> shift;
  std::uint32_t probe = 0;
  for (; table[place].occupancy != 0; ++probe) place = (place + 1) & (table.size() - 1);
  table[place] = entry;
  return probe;
}

}  // namespace

VoxelMapBuilder::VoxelMapBuilder(double resolution_m, std::size_t capacity)
    : resolution_m_(resolution_m), capacity_(capacity) {
  if (!is_resolution(resolution_m)) {
    throw std::runtime_error(fmt::format("resolution {} m is not one of 0.001 m to 1000 m", resolution_m));
  }
  if (capacity == 0 || capacity >= (std::size_t{1} << 31)) {
    throw std::runtime_error(
        fmt::format("a map of {} voxels: give between 1 and {}", capacity, (1U << 31) - 1));
  }
  try {
    cells_.reserve(capacity);
    table_.resize(std::bit_ceil(2 * capacity));
  } catch (const std::bad_alloc&) {
    throw std::runtime_error(fmt::format("no memory to build a map of {} voxels", capacity));
  }
}

VoxelMapBuilder::CellSums& VoxelMapBuilder::find_or_add(const Cell& cell) {
  const std::size_t mask = table_.size() - 1;
  std::size_t place = static_cast<std::size_t>(hash_cell(cell) >> 20) & mask;
  for (; table_[place] != 0; place = (place + 1) & mask) {
    CellSums& found = cells_[table_[place] - 1];
    if (found.cell == cell) return found;
  }
  if (cells_.size() == capacity_) {
    throw std::runtime_error(fmt::format(
        "the map is full: its points fall in more than {} cells of {} m; raise the capacity or the "
        "resolution",
        capacity_, resolution_m_));
  }
  cells_.push_back({.cell = cell});
  table_[place] = static_cast<std::uint32_t>(cells_.size());
  return cells_.back();
}

void VoxelMapBuilder::add(const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d scaled = point_m / resolution_m_;
  if (!has_cell(scaled)) {
    ++skipped_points_;
    return;
  }
  const Eigen::Vector3d lower = scaled.array().floor();
  const Cell cell{static_cast<std::int32_t>(lower.x()), static_cast<std::int32_t>(lower.y()),
                  static_cast<std::int32_t>(lower.z())};
  CellSums& sums = find_or_add(cell);
  const Eigen::Vector3d p = point_m - (lower.array() + 0.5).matrix() * resolution_m_;
  ++points_;
  ++sums.count;
  sums.sum_m += p;
  const std::array<double, 6> squares{p.x() * p.x(), p.x() * p.y(), p.x() * p.z(),
                                      p.y() * p.y(), p.y() * p.z(), p.z() * p.z()};
  for (std::size_t i = 0; i < squares.size(); ++i) sums.squares_m2[i] += squares[i];
}

MapImage VoxelMapBuilder::build() const {
  const auto to_voxel = [this](const CellSums& sums) -> std::optional<Voxel> {
    if (sums.count < kMinPoints) return std::nullopt;
    const double n = sums.count;
    const Eigen::Vector3d mean = sums.sum_m / n;
    const auto& s = sums.squares_m2;
    Eigen::Matrix3d squares;
    squares << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
    const Eigen::Matrix3d covariance = (squares - n * mean * mean.transpose()) / (n - 1.0);
    if (!(covariance.trace() > kSmallestExtent_m * kSmallestExtent_m)) return std::nullopt;
    // The inflation that makes Autoware's voxels robust, as what it is: I / (n - 1) at a resolution of 1 m.
    const double inflation_m2 = resolution_m_ * resolution_m_ / (n - 1.0);
    Voxel voxel;
    for (int axis = 0; axis < 3; ++axis) {
      voxel.mean_m[static_cast<std::size_t>(axis)] = static_cast<float>(mean[axis] + 0.5 * resolution_m_);
    }
    voxel.count = sums.count;
    voxel.sharp_1pm2 = inverse_of_bounded(covariance);
    voxel.wide_1pm2 = inverse_of_bounded(covariance + inflation_m2 * Eigen::Matrix3d::Identity());
    return voxel;
  };

  std::vector<PlacedVoxel> placed;
  placed.reserve(cells_.size());
  for (const CellSums& sums : cells_) {
    const auto voxel = to_voxel(sums);
    if (!voxel) continue;
    const std::uint64_t key = block_key(sums.cell);
    placed.push_back({key, morton(key), cell_bit(sums.cell), *voxel});
  }
  if (placed.empty()) {
    throw std::runtime_error(fmt::format(
        "no voxel of {} m has the {} points it needs: {} points in {} cells; choose a coarser resolution "
        "or a denser cloud",
        resolution_m_, kMinPoints, points_, cells_.size()));
  }
  std::sort(placed.begin(), placed.end(), [](const PlacedVoxel& a, const PlacedVoxel& b) {
    return a.order != b.order ? a.order < b.order : a.bit < b.bit;
  });

  std::size_t block_count = 1;
  for (std::size_t i = 1; i < placed.size(); ++i) block_count += placed[i].key != placed[i - 1].key ? 1U : 0U;
  const std::size_t table_size = std::max(std::bit_ceil(2 * block_count), kMinTableSize);
  const std::size_t column_size = mean_column_size(placed.size());
  MapImage image(sizeof(MapHeader) + table_size * sizeof(BlockEntry) + placed.size() * sizeof(Voxel) +
                 3 * column_size * sizeof(float));

  auto* const header = new (image.bytes().data()) MapHeader{.magic = kMapMagic,
                                                            .version = kMapVersion,
                                                            .byte_order = kMapByteOrder,
                                                            .total_bytes = image.bytes().size(),
                                                            .resolution_m = resolution_m_,
                                                            .table_size = table_size,
                                                            .voxel_count = placed.size(),
                                                            .point_count = points_};
  auto* const entries = reinterpret_cast<BlockEntry*>(image.bytes().data() + sizeof(MapHeader));
  const std::span<BlockEntry> table(entries, table_size);
  auto* const voxels = reinterpret_cast<Voxel*>(entries + table_size);
  auto* const means_m = reinterpret_cast<float*>(voxels + placed.size());
  BlockEntry block;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    voxels[i] = placed[i].voxel;
    const unsigned bit = placed[i].bit;
    const std::array<unsigned, 3> cell{bit & 3, (bit >> 2) & 3, bit >> 4};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      means_m[axis * column_size + i] =
          static_cast<float>(cell[axis] * resolution_m_) + placed[i].voxel.mean_m[axis];
    }
    if (i == 0 || placed[i].key != block.key)
      block = {.key = placed[i].key, .first_voxel = static_cast<std::uint32_t>(i)};
    block.occupancy |= std::uint64_t{1} << placed[i].bit;
    if (i + 1 == placed.size() || placed[i + 1].key != block.key) {
      header->longest_probe = std::max(header->longest_probe, insert(table, block));
    }
  }
  header->checksum = map_checksum(image.bytes());
  return image;
}

}  // namespace landfix::ndt
