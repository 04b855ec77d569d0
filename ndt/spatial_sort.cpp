#include "ndt/spatial_sort.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

namespace landfix::ndt {
namespace {

/// Eleven at a time: three passes sort the 33 bits of a scan of 400 m at 0.5 m.
constexpr unsigned kDigitBits = 11;
constexpr std::uint64_t kDigitMask = (1U << kDigitBits) - 1;

/// Puts two zeros between the lowest 21 bits.
[[nodiscard]] constexpr std::uint64_t spread(std::uint64_t bits) noexcept {
  bits &= 0x1FFFFFU;
  bits = (bits | bits << 32) & 0x001F00000000FFFFU;
  bits = (bits | bits << 16) & 0x001F0000FF0000FFU;
  bits = (bits | bits << 8) & 0x100F00F00F00F00FU;
  bits = (bits | bits << 4) & 0x10C30C30C30C30C3U;
  return (bits | bits << 2) & 0x1249249249249249U;
}

}  // namespace

std::uint64_t morton_code(std::uint64_t i, std::uint64_t j, std::uint64_t k) noexcept {
  return spread(i) << 2 | spread(j) << 1 | spread(k);
}

void sort_by_code(std::span<SpatialKey> keys, std::span<SpatialKey> scratch) noexcept {
  std::uint64_t all_or = 0;
  std::uint64_t all_and = ~std::uint64_t{0};
  for (const SpatialKey& key : keys) {
    all_or |= key.code;
    all_and &= key.code;
  }
  const std::uint64_t differing = all_or & ~all_and;
  std::span<SpatialKey> from = keys;
  std::span<SpatialKey> to = scratch.first(keys.size());
  // From the lowest bits up; each pass keeps the order of the one before.
  for (std::uint64_t rest = differing; rest != 0;) {
    const int shift = std::countr_zero(rest);
    rest &= ~(kDigitMask << shift);
    const auto digit = [shift](const SpatialKey& key) { return key.code >> shift & kDigitMask; };
    std::array<std::uint32_t, kDigitMask + 1> starts{};
    for (const SpatialKey& key : from) ++starts[digit(key)];
    std::uint32_t start = 0;
    for (std::uint32_t& count : starts) {
      const std::uint32_t next = start + count;
      count = start;
      start = next;
    }
    for (const SpatialKey& key : from) to[starts[digit(key)]++] = key;
    std::swap(from, to);
  }
  if (from.data() != keys.data()) std::copy(from.begin(), from.end(), keys.begin());
}

}  // namespace landfix::ndt
