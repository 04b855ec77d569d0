// The checksums of end-to-end protection, as AUTOSAR's CRC library defines their polynomials, a byte at a
// time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace landfix::platform {

namespace crc_detail {

/// What each byte leaves in a register of `Register`'s width, highest bit first.
template <class Register>
[[nodiscard]] constexpr std::array<Register, 256> table_of(unsigned polynomial) noexcept {
  constexpr unsigned kWidth = 8 * sizeof(Register);
  std::array<Register, 256> table{};
  for (unsigned value = 0; value < table.size(); ++value) {
    unsigned crc = value << (kWidth - 8);
    for (int bit = 0; bit < 8; ++bit) crc = crc << 1 ^ ((crc >> (kWidth - 1) & 1U) != 0 ? polynomial : 0);
    table[value] = static_cast<Register>(crc);
  }
  return table;
}

inline constexpr auto kTable8 = table_of<std::uint8_t>(0x1D);
inline constexpr auto kTable16 = table_of<std::uint16_t>(0x1021);

}  // namespace crc_detail

/// x^8 + x^4 + x^3 + x^2 + 1 (SAE J1850), without the standard's start and final values: `crc` is what came
/// before, 0 at first.
[[nodiscard]] constexpr std::uint8_t crc8(std::span<const std::byte> bytes, std::uint8_t crc = 0) noexcept {
  for (const std::byte byte : bytes) crc = crc_detail::kTable8[crc ^ std::to_integer<std::uint8_t>(byte)];
  return crc;
}

/// x^16 + x^12 + x^5 + 1 (CCITT), begun with 0xFFFF ("CCITT-FALSE").
[[nodiscard]] constexpr std::uint16_t crc16(std::span<const std::byte> bytes,
                                            std::uint16_t crc = 0xFFFF) noexcept {
  for (const std::byte byte : bytes) {
    const auto index = static_cast<std::uint8_t>(crc >> 8 ^ std::to_integer<unsigned>(byte));
    crc = static_cast<std::uint16_t>(crc << 8 ^ crc_detail::kTable16[index]);
  }
  return crc;
}

}  // namespace landfix::platform
