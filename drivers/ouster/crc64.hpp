// CRC-64/XZ, with which firmware from 2.5 on ends its packets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace landfix::drivers::ouster {

/// ECMA-182's polynomial, reflected; starts from and ends with all ones inverted. "123456789" gives
/// 995DC9BBDF1939FA.
[[nodiscard]] std::uint64_t crc64(std::span<const std::byte> bytes) noexcept;

/// The same, by tables alone: what runs on processors without a carry-less multiplication.
[[nodiscard]] std::uint64_t crc64_by_tables(std::span<const std::byte> bytes) noexcept;

}  // namespace landfix::drivers::ouster
