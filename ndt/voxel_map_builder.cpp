#include "ndt/voxel_map_builder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "ndt/map_file.hpp"

namespace landfix::ndt {
namespace {

constexpr std::size_t kFirstTableSize = 1024;

[[nodiscard]] std::size_t first_place(std::uint64_t key, std::size_t table_size) noexcept {
  return hash_key(key) >> (64U - static_cast<unsigned>(std::countr_zero(table_size)));
}

}  // namespace

VoxelMapBuilder::VoxelMapBuilder(double resolution_m, std::size_t capacity, PointSource source)
    : resolution_m_(resolution_m),
      inverse_resolution_1pm_(1.0 / resolution_m),
      capacity_(capacity),
      source_(source) {
  if (!is_resolution(resolution_m)) {
    throw std::runtime_error(fmt::format("resolution {} m is not one of 0.001 m to 1000 m", resolution_m));
  }
  if (capacity == 0 || capacity >= (std::size_t{1} << 31)) {
    throw std::runtime_error(
        fmt::format("a map of {} voxels: give between 1 and {}", capacity, (1U << 31) - 1));
  }
  try {
    // The system provides the pages as they are written: room that is not used costs nothing.
    cells_.reserve(capacity);
    table_.resize(kFirstTableSize);
  } catch (const std::bad_alloc&) {
    throw std::runtime_error(fmt::format("no memory to build a map of {} voxels", capacity));
  }
}

void VoxelMapBuilder::grow_table() {
  std::vector<std::uint32_t> larger(2 * table_.size());
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    std::size_t place = first_place(blocks_[i].key, larger.size());
    while (larger[place] != 0) place = (place + 1) & (larger.size() - 1);
    larger[place] = static_cast<std::uint32_t>(i + 1);
  }
  table_.swap(larger);
}

VoxelMapBuilder::Block& VoxelMapBuilder::find_or_add(std::uint64_t key) {
  if (last_block_ < blocks_.size() && blocks_[last_block_].key == key) return blocks_[last_block_];
  std::size_t place = first_place(key, table_.size());
  for (; table_[place] != 0; place = (place + 1) & (table_.size() - 1)) {
    last_block_ = table_[place] - 1;
    if (blocks_[last_block_].key == key) return blocks_[last_block_];
  }
  last_block_ = blocks_.size();
  blocks_.push_back({.key = key});
  table_[place] = static_cast<std::uint32_t>(blocks_.size());
  if (2 * blocks_.size() > table_.size()) grow_table();
  return blocks_.back();
}

void VoxelMapBuilder::add(const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d scaled = point_m * inverse_resolution_1pm_;
  if (!has_cell(scaled)) {
    ++skipped_points_;
    return;
  }
  const Cell cell = cell_of(scaled);
  std::uint32_t& place = find_or_add(block_key(cell)).cells[cell_bit(cell)];
  if (place == 0) {
    if (cells_.size() == capacity_) {
      throw std::runtime_error(fmt::format(
          "the map is full: its points fall in more than {} cells of {} m; raise the capacity or the "
          "resolution",
          capacity_, resolution_m_));
    }
    cells_.emplace_back();
    place = static_cast<std::uint32_t>(cells_.size());
  }
  ++points_;
  cells_[place - 1].add(point_m.x() - (cell.i + 0.5) * resolution_m_,
                        point_m.y() - (cell.j + 0.5) * resolution_m_,
                        point_m.z() - (cell.k + 0.5) * resolution_m_);
}

void VoxelMapBuilder::forget_beyond(const Eigen::Vector3d& place_m, double within_m) {
  VoxelMapBuilder kept(resolution_m_, capacity_, source_);
  kept.skipped_points_ = skipped_points_;
  for (const Block& block : blocks_) {
    const Cell corner = block_corner(block.key);
    const Eigen::Vector2d middle_m = resolution_m_ * Eigen::Vector2d(corner.i + 2, corner.j + 2);
    if ((middle_m - place_m.head<2>()).norm() > within_m) continue;
    Block& copy = kept.find_or_add(block.key);
    for (std::size_t bit = 0; bit < block.cells.size(); ++bit) {
      if (block.cells[bit] == 0) continue;
      const VoxelMoments& cell = kept.cells_.emplace_back(cells_[block.cells[bit] - 1]);
      copy.cells[bit] = static_cast<std::uint32_t>(kept.cells_.size());
      kept.points_ += cell.count;
    }
  }
  *this = std::move(kept);
}

std::vector<VoxelMapBuilder::PlacedBlock> VoxelMapBuilder::blocks_in_order() const {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(blocks_.size());
  for (std::uint32_t i = 0; i < blocks_.size(); ++i) order.emplace_back(morton_code(blocks_[i].key), i);
  std::sort(order.begin(), order.end());

  std::vector<PlacedBlock> placed;
  placed.reserve(blocks_.size());
  for (const auto& [code, index] : order) {
    const Block& block = blocks_[index];
    TileBlock in_map{.key = block.key};
    for (unsigned bit = 0; bit < block.cells.size(); ++bit) {
      if (block.cells[bit] != 0 && has_shape(cells_[block.cells[bit] - 1])) {
        in_map.occupancy |= std::uint64_t{1} << bit;
      }
    }
    if (in_map.occupancy != 0) placed.push_back({in_map, index});
  }
  return placed;
}

MapImage VoxelMapBuilder::build() const {
  const std::vector<PlacedBlock> placed = blocks_in_order();
  std::vector<TileBlock> blocks;
  blocks.reserve(placed.size());
  for (const PlacedBlock& block : placed) blocks.push_back(block.in_map);
  if (points_ == 0 && skipped_points_ != 0) {
    throw std::runtime_error(fmt::format("all {} points lie beyond the lattice, which reaches to {:.0f} m",
                                         skipped_points_, kMaxCell * resolution_m_));
  }
  if (blocks.empty()) {
    throw std::runtime_error(fmt::format(
        "no voxel of {} m has the {} points it needs: {} points in {} cells; choose a coarser resolution "
        "or a denser cloud",
        resolution_m_, kMinVoxelPoints, points_, cells_.size()));
  }
  std::size_t known = placed.size();
  VoxelMoments around;
  return make_map(resolution_m_, points_, blocks, [&](std::size_t block, unsigned bit) {
    const Block& cells = blocks_[placed[block].index];
    const VoxelMoments& moments = cells_[cells.cells[bit] - 1];
    if (source_ == PointSource::survey) return to_voxel(moments, resolution_m_);
    if (std::exchange(known, block) != block) around = moments_of(cells);
    return to_voxel(moments, resolution_m_, &around);
  });
}

/// About the centre of its lowest cell.
VoxelMoments VoxelMapBuilder::moments_of(const Block& block) const {
  VoxelMoments sum;
  for (unsigned bit = 0; bit < block.cells.size(); ++bit) {
    if (block.cells[bit] == 0) continue;
    const Cell cell = cell_in_block(bit);
    sum.add(cells_[block.cells[bit] - 1],
            {cell.i * resolution_m_, cell.j * resolution_m_, cell.k * resolution_m_});
  }
  return sum;
}

}  // namespace landfix::ndt
