#include "ndt/map_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>

#include "ndt/crc32c.hpp"

namespace landfix::ndt {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the map file is little-endian, as all our targets are");

}  // namespace

std::uint32_t map_checksum(std::span<const std::byte> image) noexcept {
  constexpr std::size_t kField = offsetof(MapHeader, checksum);
  constexpr std::array<std::byte, sizeof(MapHeader::checksum)> kZero{};
  std::uint32_t crc = crc32c_update(kCrc32cStart, image.first(kField));
  crc = crc32c_update(crc, kZero);
  return ~crc32c_update(crc, image.subspan(kField + kZero.size()));
}

void validate_map(std::span<const std::byte> image, const std::string& name) {
  const auto refuse = [&name](const std::string& why) { throw std::runtime_error(name + ": " + why); };
  MapHeader header;
  if (image.size() < sizeof header) {
    refuse(fmt::format("not a map: {} bytes, a map has at least {}", image.size(), sizeof header));
  }
  std::memcpy(&header, image.data(), sizeof header);
  if (header.magic != kMapMagic) refuse("not a landfix map; `landfix map` makes one from a PCD file");
  if (header.byte_order != kMapByteOrder)
    refuse("a map of another byte order; build it again on this computer");
  if (header.version != kMapVersion) {
    refuse(fmt::format("map version {}, this program reads {}; build it again with `landfix map`",
                       header.version, kMapVersion));
  }
  if (header.total_bytes != image.size()) {
    refuse(
        fmt::format("truncated: {} bytes of {}; copy or build it again", image.size(), header.total_bytes));
  }
  const std::uint64_t body = image.size() - sizeof header;
  const bool sizes_agree = std::has_single_bit(header.table_size) && header.table_size >= kMinTableSize &&
                           header.table_size <= body / sizeof(BlockEntry) &&
                           header.voxel_count <= body / sizeof(Voxel) &&
                           header.table_size * sizeof(BlockEntry) + header.voxel_count * sizeof(Voxel) +
                                   3 * mean_column_size(header.voxel_count) * sizeof(float) ==
                               body;
  if (!sizes_agree || !is_resolution(header.resolution_m) || header.longest_probe >= header.table_size) {
    refuse("its header is damaged; copy or build it again");
  }
  if (header.voxel_count == 0) refuse("it holds no voxel; build it again");
  if (header.checksum != map_checksum(image))
    refuse("its checksum does not match: it is damaged; copy or build it again");
  const VoxelMap map(image);
  for (const BlockEntry& block : map.blocks()) {
    const auto voxels = static_cast<std::uint64_t>(std::popcount(block.occupancy));
    if (block.first_voxel + voxels > header.voxel_count)
      refuse("a block points outside the map; build it again");
  }
}

MapImage load_map(std::span<const std::byte> file, const std::string& name) {
  MapImage image(file.size());
  std::copy(file.begin(), file.end(), image.bytes().begin());
  validate_map(image.bytes(), name);
  return image;
}

}  // namespace landfix::ndt
