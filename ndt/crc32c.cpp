#include "ndt/crc32c.hpp"

#include <array>
#include <cstring>

#if defined(__x86_64__)
#include <nmmintrin.h>
#elif defined(__aarch64__)
#include <arm_acle.h>
#include <sys/auxv.h>
#endif

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

#if defined(__x86_64__)
constexpr bool kHasInstruction = true;
#define LANDFIX_CRC_TARGET __attribute__((target("sse4.2")))
LANDFIX_CRC_TARGET inline std::uint32_t step(std::uint32_t crc, std::uint64_t word) noexcept {
  return static_cast<std::uint32_t>(_mm_crc32_u64(crc, word));
}
[[nodiscard]] bool processor_has_instruction() noexcept { return __builtin_cpu_supports("sse4.2"); }
#elif defined(__aarch64__)
constexpr bool kHasInstruction = true;
#define LANDFIX_CRC_TARGET __attribute__((target("+crc")))
LANDFIX_CRC_TARGET inline std::uint32_t step(std::uint32_t crc, std::uint64_t word) noexcept {
  return __crc32cd(crc, word);
}
[[nodiscard]] bool processor_has_instruction() noexcept {
  constexpr unsigned long kCrc32 = 1UL << 7;  // HWCAP_CRC32
  return (::getauxval(AT_HWCAP) & kCrc32) != 0;
}
#else
constexpr bool kHasInstruction = false;
#define LANDFIX_CRC_TARGET
inline std::uint32_t step(std::uint32_t crc, std::uint64_t /*word*/) noexcept { return crc; }
[[nodiscard]] bool processor_has_instruction() noexcept { return false; }
#endif

/// The whole words of `bytes`; the rest is the table's.
LANDFIX_CRC_TARGET std::uint32_t update_by_instruction(std::uint32_t crc,
                                                       std::span<const std::byte>& bytes) noexcept {
  while (bytes.size() >= 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), 8);
    crc = step(crc, word);
    bytes = bytes.subspan(8);
  }
  return crc;
}

const bool kUseInstruction = kHasInstruction && processor_has_instruction();

}  // namespace

std::uint32_t crc32c_update(std::uint32_t crc, std::span<const std::byte> bytes) noexcept {
  if (kUseInstruction) crc = update_by_instruction(crc, bytes);
  return crc32c_update_by_table(crc, bytes);
}

// Eight bytes a step ("slicing by 8").
std::uint32_t crc32c_update_by_table(std::uint32_t crc, std::span<const std::byte> bytes) noexcept {
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
