// Fields of wire formats in big-endian (network) order, at any alignment.
#pragma once

#include <cstddef>
#include <cstdint>

namespace landfix::drivers {

/// An unsigned integer of `Bytes` bytes, most significant byte first. The caller has checked the size.
template <class Integer, std::size_t Bytes = sizeof(Integer)>
[[nodiscard]] constexpr Integer load_big_endian(const std::byte* bytes) noexcept {
  static_assert(Bytes <= sizeof(Integer));
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < Bytes; ++i) value = value << 8U | std::to_integer<std::uint64_t>(bytes[i]);
  return static_cast<Integer>(value);
}

}  // namespace landfix::drivers
