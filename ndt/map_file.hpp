// The map on disk: the image of a VoxelMap as it lies in memory (map_layout.hpp), so that a start is a
// page-in and a check. Every byte is covered by one of its CRC-32C: the header's, the index', the
// directory's, or that of a tile's voxels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "ndt/map_image.hpp"
#include "ndt/map_layout.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// A map of `blocks`, in Morton order, which has at least one. `voxel(block, bit)` makes the voxel of each of
/// a block's bits. Throws std::runtime_error where the memory cannot be had.
[[nodiscard]] MapImage make_map(double resolution_m, std::uint64_t points, std::span<const TileBlock> blocks,
                                const std::function<Voxel(std::size_t block, unsigned bit)>& voxel);

/// The header at the begin of a file of `file_bytes`. Throws std::runtime_error that begins with `name` and
/// says why it is not that of a usable map: foreign, newer, of another byte order, truncated, damaged.
[[nodiscard]] MapHeader check_map_header(std::span<const std::byte> begin, std::uint64_t file_bytes,
                                         const std::string& name);

/// The same for the directory. After it returns, blocks and tiles are as map_layout.hpp says.
void check_map_directory(const MapHeader& header, std::span<const TileBlock> blocks,
                         std::span<const TileEntry> tiles, const std::string& name);

/// Whether a tile's voxels are as they were written.
[[nodiscard]] bool is_intact(const TileEntry& tile, std::span<const Voxel> voxels) noexcept;

/// All of it. Throws as above. After it returns, reading the map stays within the image.
void validate_map(std::span<const std::byte> image, const std::string& name);

/// Makes the checksums right again: for tests that damage more than bytes.
void seal_map(std::span<std::byte> image) noexcept;

/// The bytes of a map file as a validated image in memory of its own.
[[nodiscard]] MapImage load_map(std::span<const std::byte> file, const std::string& name);

}  // namespace landfix::ndt
