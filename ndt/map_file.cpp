#include "ndt/map_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "ndt/crc32c.hpp"
#include "ndt/map_assembler.hpp"

namespace landfix::ndt {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the map file is little-endian, as all our targets are");

[[noreturn]] void refuse(const std::string& name, std::string_view why) {
  throw std::runtime_error(fmt::format("{}: {}", name, why));
}

[[nodiscard]] std::uint32_t header_checksum(MapHeader header) noexcept {
  header.header_checksum = 0;
  return crc32c(std::as_bytes(std::span(&header, 1)));
}

[[nodiscard]] std::uint32_t directory_checksum(std::span<const TileBlock> blocks,
                                               std::span<const TileEntry> tiles) noexcept {
  return ~crc32c_update(crc32c_update(kCrc32cStart, std::as_bytes(blocks)), std::as_bytes(tiles));
}

/// The parts of an image of which the map's view knows nothing.
struct Parts {
  Parts(std::span<const std::byte> image, const MapHeader& header) noexcept {
    const MapLayout layout(header);
    index = image.subspan(layout.table, layout.voxels - layout.table);
    blocks = {reinterpret_cast<const TileBlock*>(image.data() + layout.blocks), header.block_count};
    tiles = {reinterpret_cast<const TileEntry*>(image.data() + layout.tiles), header.tile_count};
  }
  std::span<const std::byte> index;
  std::span<const TileBlock> blocks;
  std::span<const TileEntry> tiles;
};

[[nodiscard]] std::vector<TileEntry> tiles_of(std::span<const TileBlock> blocks) {
  std::vector<TileEntry> tiles;
  std::uint32_t voxel = 0;
  for (std::uint32_t i = 0; i < blocks.size(); ++i) {
    const std::uint64_t key = tile_key(blocks[i].key);
    if (tiles.empty() || tiles.back().key != key) {
      tiles.push_back({.key = key, .first_block = i, .first_voxel = voxel});
    }
    const auto voxels = static_cast<std::uint32_t>(std::popcount(blocks[i].occupancy));
    ++tiles.back().blocks;
    tiles.back().voxels += voxels;
    voxel += voxels;
  }
  return tiles;
}

/// The sizes are checked one by one first, so that their sum cannot wrap.
[[nodiscard]] bool sizes_agree(const MapHeader& header) noexcept {
  const std::uint64_t bytes = header.total_bytes;
  return std::has_single_bit(header.table_size) && header.table_size >= kMinTableSize &&
         header.table_size <= bytes / sizeof(BlockEntry) && header.voxel_count <= bytes / sizeof(Voxel) &&
         header.block_count <= bytes / sizeof(TileBlock) && header.tile_count <= bytes / sizeof(TileEntry) &&
         header.longest_probe < header.table_size && MapLayout(header).end == bytes;
}

}  // namespace

MapImage make_map(double resolution_m, std::uint64_t points, std::span<const TileBlock> blocks,
                  const std::function<Voxel(std::size_t, unsigned)>& voxel) {
  const std::vector<TileEntry> tiles = tiles_of(blocks);
  MapHeader header{.magic = kMapMagic,
                   .version = kMapVersion,
                   .byte_order = kMapByteOrder,
                   .resolution_m = resolution_m,
                   .table_size = hash_table_size(blocks.size()),
                   .voxel_count = tiles.back().first_voxel + tiles.back().voxels,
                   .block_count = blocks.size(),
                   .tile_count = tiles.size(),
                   .point_count = points};
  const MapLayout layout(header);
  header.total_bytes = layout.end;
  MapMemory memory(layout.end);

  MapAssembler assembler(memory.bytes(), header);
  std::uint32_t next = 0;
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    const std::uint32_t first = next;
    for (std::uint64_t rest = blocks[block].occupancy; rest != 0; rest &= rest - 1) {
      assembler.voxels()[next++] = voxel(block, static_cast<unsigned>(std::countr_zero(rest)));
    }
    assembler.add(blocks[block], first);
  }
  const auto copy_to = [&memory](std::uint64_t offset, std::span<const std::byte> bytes) {
    std::copy(bytes.begin(), bytes.end(), memory.bytes().begin() + static_cast<std::ptrdiff_t>(offset));
  };
  copy_to(layout.blocks, std::as_bytes(blocks));
  copy_to(layout.tiles, std::as_bytes(std::span(tiles)));
  seal_map(memory.bytes());
  return MapImage(std::move(memory));
}

MapHeader check_map_header(std::span<const std::byte> begin, std::uint64_t file_bytes,
                           const std::string& name) {
  MapHeader header;
  if (begin.size() >= kMapMagic.size() && std::memcmp(begin.data(), kMapMagic.data(), kMapMagic.size()) != 0)
    refuse(name, "not a landfix map; `landfix map` makes one from a PCD file");
  if (begin.size() < sizeof header) {
    refuse(name, fmt::format("not a map: {} bytes, a map has at least {}", file_bytes, sizeof header));
  }
  std::memcpy(&header, begin.data(), sizeof header);
  if (header.byte_order != kMapByteOrder)
    refuse(name, "a map of another byte order; build it again on this computer");
  if (header.version != kMapVersion) {
    refuse(name, fmt::format("map version {}, this program reads {}; build it again with `landfix map`",
                             header.version, kMapVersion));
  }
  if (header.header_checksum != header_checksum(header))
    refuse(name, "its header is damaged; copy or build it again");
  if (header.total_bytes > file_bytes) {
    refuse(name,
           fmt::format("truncated: {} bytes of {}; copy or build it again", file_bytes, header.total_bytes));
  }
  if (header.total_bytes < file_bytes) {
    refuse(name, fmt::format("{} bytes, {} more than a map of its size has; copy or build it again",
                             file_bytes, file_bytes - header.total_bytes));
  }
  if (!sizes_agree(header) || !is_resolution(header.resolution_m))
    refuse(name, "its header makes no sense; build it again");
  if (header.voxel_count == 0 || header.tile_count == 0 ||
      header.voxel_count > std::numeric_limits<std::uint32_t>::max()) {
    refuse(name, fmt::format("it holds {} voxels; build it again", header.voxel_count));
  }
  return header;
}

void check_map_directory(const MapHeader& header, std::span<const TileBlock> blocks,
                         std::span<const TileEntry> tiles, const std::string& name) {
  if (header.directory_checksum != directory_checksum(blocks, tiles))
    refuse(name, "its directory of tiles is damaged; copy or build it again");
  // Sums of 64 bits: those of a made-up file may be large.
  std::uint64_t block = 0;
  std::uint64_t voxel = 0;
  for (const TileEntry& tile : tiles) {
    bool is_run =
        tile.first_block == block && tile.first_voxel == voxel && tile.blocks <= blocks.size() - block;
    std::uint64_t voxels = 0;
    for (std::size_t i = 0; is_run && i < tile.blocks; ++i) {
      is_run = blocks[block + i].occupancy != 0 && tile_key(blocks[block + i].key) == tile.key;
      voxels += static_cast<std::uint64_t>(std::popcount(blocks[block + i].occupancy));
    }
    if (!is_run || voxels != tile.voxels)
      refuse(name, "a tile of its directory is not what its blocks make; build it again");
    block += tile.blocks;
    voxel += voxels;
  }
  if (block != blocks.size() || voxel != header.voxel_count)
    refuse(name, "its directory does not cover its voxels; build it again");
}

bool is_intact(const TileEntry& tile, std::span<const Voxel> voxels) noexcept {
  return tile.checksum == crc32c(std::as_bytes(voxels));
}

void validate_map(std::span<const std::byte> image, const std::string& name) {
  const MapHeader header = check_map_header(image, image.size(), name);
  const Parts parts(image, header);
  check_map_directory(header, parts.blocks, parts.tiles, name);
  if (header.index_checksum != crc32c(parts.index))
    refuse(name, "its index is damaged; copy or build it again");
  const VoxelMap map(image);
  for (const TileEntry& tile : parts.tiles) {
    if (is_intact(tile, map.voxels().subspan(tile.first_voxel, tile.voxels))) continue;
    const Cell corner = tile_corner(tile.key);
    refuse(name, fmt::format("its tile from ({:.0f}, {:.0f}, {:.0f}) m on is damaged; copy or build it again",
                             corner.i * header.resolution_m, corner.j * header.resolution_m,
                             corner.k * header.resolution_m));
  }
  for (const BlockEntry& block : map.blocks()) {
    const auto voxels = static_cast<std::uint64_t>(std::popcount(block.occupancy));
    if (block.first_voxel + voxels > header.voxel_count)
      refuse(name, "a block points outside the map; build it again");
  }
}

void seal_map(std::span<std::byte> image) noexcept {
  MapHeader& header = *reinterpret_cast<MapHeader*>(image.data());
  const MapLayout layout(header);
  const auto* const voxels = reinterpret_cast<const Voxel*>(image.data() + layout.voxels);
  auto* const tiles = reinterpret_cast<TileEntry*>(image.data() + layout.tiles);
  for (TileEntry& tile : std::span(tiles, header.tile_count)) {
    if (std::uint64_t{tile.first_voxel} + tile.voxels > header.voxel_count) continue;  // damaged by intent
    tile.checksum = crc32c(std::as_bytes(std::span(voxels + tile.first_voxel, tile.voxels)));
  }
  const Parts parts(image, header);
  header.index_checksum = crc32c(parts.index);
  header.directory_checksum = directory_checksum(parts.blocks, parts.tiles);
  header.header_checksum = header_checksum(header);
}

MapImage load_map(std::span<const std::byte> file, const std::string& name) {
  MapMemory memory(file.size());
  std::copy(file.begin(), file.end(), memory.bytes().begin());
  validate_map(memory.bytes(), name);
  return MapImage(std::move(memory));
}

}  // namespace landfix::ndt
