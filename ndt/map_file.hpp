// The map on disk: the image of a VoxelMap as it lies in memory, so that a start is a read and a check.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ndt/map_image.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// The voxels of a table of this size begin on a line of their own.
inline constexpr std::size_t kMinTableSize = 8;

/// CRC-32C (Castagnoli) of an image with its checksum field taken as 0.
[[nodiscard]] std::uint32_t map_checksum(std::span<const std::byte> image) noexcept;

/// Throws std::runtime_error that begins with `name` and says why `image` is not a usable map: foreign,
/// newer, of another byte order, truncated, damaged, or inconsistent. After it returns, reading the map stays
/// within the image.
void validate_map(std::span<const std::byte> image, const std::string& name);

/// The bytes of a map file as a validated image in memory of its own.
[[nodiscard]] MapImage load_map(std::span<const std::byte> file, const std::string& name);

}  // namespace landfix::ndt
