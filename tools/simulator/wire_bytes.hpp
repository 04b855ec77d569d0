// Writes the fields of packets, byte by byte, in either order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace landfix::tools::simulator {

/// The low `size` bytes of `value`, least significant first.
inline void put_little(std::span<std::byte> bytes, std::size_t at, std::uint64_t value,
                       std::size_t size) noexcept {
  for (std::size_t i = 0; i < size; ++i) bytes[at + i] = static_cast<std::byte>((value >> (8 * i)) & 0xFF);
}

/// The low `size` bytes of `value`, most significant first.
inline void put_big(std::span<std::byte> bytes, std::size_t at, std::uint64_t value,
                    std::size_t size) noexcept {
  for (std::size_t i = 0; i < size; ++i) {
    bytes[at + i] = static_cast<std::byte>((value >> (8 * (size - 1 - i))) & 0xFF);
  }
}

/// A range in units of the wire; 0, which is none, where it does not fit.
[[nodiscard]] constexpr std::uint16_t to_range_raw(double range_m, double unit_m) noexcept {
  const double raw = range_m / unit_m + 0.5;
  return raw >= 1.0 && raw < 65536.0 ? static_cast<std::uint16_t>(raw) : std::uint16_t{0};
}

}  // namespace landfix::tools::simulator
