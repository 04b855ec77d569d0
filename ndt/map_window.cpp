#include "ndt/map_window.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "ndt/map_assembler.hpp"
#include "ndt/map_file.hpp"

namespace landfix::ndt {

MapDirectory read_map_directory(const ReadAt& read_at, std::uint64_t file_bytes, const std::string& name) {
  const auto read = [&](std::uint64_t offset, std::span<std::byte> into) {
    if (!read_at(offset, into)) throw std::runtime_error(name + ": cannot read it; copy or build it again");
  };
  MapDirectory directory;
  std::vector<std::byte> begin(std::min<std::uint64_t>(file_bytes, sizeof(MapHeader)));
  read(0, begin);
  directory.header = check_map_header(begin, file_bytes, name);
  const MapLayout layout(directory.header);
  directory.blocks.resize(directory.header.block_count);
  directory.tiles.resize(directory.header.tile_count);
  read(layout.blocks, std::as_writable_bytes(std::span(directory.blocks)));
  read(layout.tiles, std::as_writable_bytes(std::span(directory.tiles)));
  check_map_directory(directory.header, directory.blocks, directory.tiles, name);
  return directory;
}

WindowAssembler::WindowAssembler(MapDirectory directory, ReadAt read_at, double radius_m)
    : directory_(std::move(directory)), read_at_(std::move(read_at)), radius_m_(radius_m) {
  candidates_.reserve(directory_.tiles.size());
}

double WindowAssembler::distance_m(const TileEntry& tile, const Eigen::Vector3d& place_m) const noexcept {
  const double edge_m = kTileCells * directory_.header.resolution_m;
  const Cell corner = tile_corner(tile.key);
  const auto beyond_m = [edge_m](std::int32_t cell, double at_m) {
    const double from_m = cell * (edge_m / kTileCells);
    return std::max({from_m - at_m, at_m - (from_m + edge_m), 0.0});
  };
  return std::hypot(beyond_m(corner.i, place_m.x()), beyond_m(corner.j, place_m.y()));
}

std::span<const WindowAssembler::Candidate> WindowAssembler::choose(std::size_t bytes,
                                                                    const Eigen::Vector3d& centre_m,
                                                                    MapHeader& header,
                                                                    WindowContent& content) {
  candidates_.clear();
  for (std::uint32_t tile = 0; tile < directory_.tiles.size(); ++tile) {
    const double away_m = distance_m(directory_.tiles[tile], centre_m);
    if (away_m <= radius_m_) candidates_.push_back({away_m, tile});
  }
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.tile < b.tile;
  });
  std::uint64_t blocks = 0;
  for (const Candidate& candidate : candidates_) {
    const TileEntry& tile = directory_.tiles[candidate.tile];
    MapHeader larger = header;
    larger.voxel_count += tile.voxels;
    larger.table_size = hash_table_size(blocks + tile.blocks);
    if (MapLayout(larger).end > bytes) break;
    header = larger;
    blocks += tile.blocks;
    ++content.tiles;
  }
  content.tiles_not_fitting = candidates_.size() - content.tiles;
  const auto chosen = std::span(candidates_).first(content.tiles);
  std::sort(chosen.begin(), chosen.end(),
            [](const Candidate& a, const Candidate& b) { return a.tile < b.tile; });
  return chosen;
}

WindowContent WindowAssembler::assemble(std::span<std::byte> memory, const Eigen::Vector3d& centre_m) {
  WindowContent content;
  MapHeader header = directory_.header;
  header.table_size = kMinTableSize;
  header.longest_probe = 0;
  // A window has no directory.
  header.voxel_count = header.block_count = header.tile_count = 0;
  const std::span<const Candidate> chosen = choose(memory.size(), centre_m, header, content);
  header.total_bytes = MapLayout(header).end;

  const MapLayout file(directory_.header);
  MapAssembler assembler(memory, header);
  std::uint32_t next = 0;
  for (const Candidate& candidate : chosen) {
    const TileEntry& tile = directory_.tiles[candidate.tile];
    const std::span<Voxel> voxels = assembler.voxels().subspan(next, tile.voxels);
    if (!read_at_(file.voxels + tile.first_voxel * sizeof(Voxel), std::as_writable_bytes(voxels)) ||
        !is_intact(tile, voxels)) {
      ++content.tiles_unreadable;
      --content.tiles;
      std::fill(voxels.begin(), voxels.end(), Voxel{});
      next += tile.voxels;
      continue;
    }
    for (const TileBlock& block : std::span(directory_.blocks).subspan(tile.first_block, tile.blocks)) {
      assembler.add(block, next);
      next += static_cast<std::uint32_t>(std::popcount(block.occupancy));
    }
    content.voxels += tile.voxels;
  }
  return content;
}

}  // namespace landfix::ndt
