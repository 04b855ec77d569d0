#include "ndt/crc32c.hpp"

#include <array>
#include <cstring>

namespace landfix::ndt {
namespace {

constexpr auto kCrc32c = [] {
  std::array<std::array<std::uint32_t, 256>, 8> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0x82F63B78U : 0U);
    table[0][byte] = crc;
  }
  for (std::size_t slice = 1; slice < 8; ++slice) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t crc = table[slice - 1][byte];
      table[slice][byte] = (crc >> 8) ^ table[0][crc & 0xFF];
    }
  }
  return table;
}();

}  // namespace

// Eight bytes a step ("slicing by 8"): maps are hundreds of megabytes.
std::uint32_t crc32c_update(std::uint32_t crc, std::span<const std::byte> bytes) noexcept {
  while (bytes.size() >= 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), 8);
    word ^= crc;
    crc = 0;
    for (unsigned slice = 0; slice < 8; ++slice) crc ^= kCrc32c[7 - slice][(word >> (8 * slice)) & 0xFF];
    bytes = bytes.subspan(8);
  }
  for (const std::byte byte : bytes)
    crc = (crc >> 8) ^ kCrc32c[0][(crc ^ static_cast<std::uint32_t>(byte)) & 0xFF];
  return crc;
}

}  // namespace landfix::ndt
