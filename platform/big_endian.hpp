// Network byte order: reading and writing integers within packets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace landfix::platform {

/// The caller has checked that `offset` + 2 bytes are there.
[[nodiscard]] constexpr std::uint16_t load_be16(std::span<const std::byte> bytes,
                                                std::size_t offset) noexcept {
  return static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[offset]) << 8 |
                                    std::to_integer<unsigned>(bytes[offset + 1]));
}

/// The caller has checked that `offset` + 4 bytes are there.
[[nodiscard]] constexpr std::uint32_t load_be32(std::span<const std::byte> bytes,
                                                std::size_t offset) noexcept {
  return std::uint32_t{load_be16(bytes, offset)} << 16 | load_be16(bytes, offset + 2);
}

constexpr void store_be16(std::span<std::byte> bytes, std::size_t offset, std::uint16_t value) noexcept {
  bytes[offset] = static_cast<std::byte>(value >> 8);
  bytes[offset + 1] = static_cast<std::byte>(value & 0xFF);
}

constexpr void store_be32(std::span<std::byte> bytes, std::size_t offset, std::uint32_t value) noexcept {
  store_be16(bytes, offset, static_cast<std::uint16_t>(value >> 16));
  store_be16(bytes, offset + 2, static_cast<std::uint16_t>(value & 0xFFFF));
}

}  // namespace landfix::platform
