// CRC-32C (Castagnoli): polynomial 0x1EDC6F41, reflected, start and final inversion all ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace landfix::ndt {

inline constexpr std::uint32_t kCrc32cStart = 0xFFFFFFFFU;

/// Takes more bytes into a running sum; the checksum is the complement of the last one.
[[nodiscard]] std::uint32_t crc32c_update(std::uint32_t crc, std::span<const std::byte> bytes) noexcept;

}  // namespace landfix::ndt
