// CRC-32C (Castagnoli): polynomial 0x1EDC6F41, reflected, start and final inversion all ones. By the
// processor's own instruction where it has one (x86 SSE4.2, Arm CRC32), which a map of hundreds of megabytes
// needs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace landfix::ndt {

inline constexpr std::uint32_t kCrc32cStart = 0xFFFFFFFFU;

/// Takes more bytes into a running sum; the checksum is the complement of the last one.
[[nodiscard]] std::uint32_t crc32c_update(std::uint32_t crc, std::span<const std::byte> bytes) noexcept;
/// The same by table, on any processor.
[[nodiscard]] std::uint32_t crc32c_update_by_table(std::uint32_t crc,
                                                   std::span<const std::byte> bytes) noexcept;

[[nodiscard]] inline std::uint32_t crc32c(std::span<const std::byte> bytes) noexcept {
  return ~crc32c_update(kCrc32cStart, bytes);
}

}  // namespace landfix::ndt
