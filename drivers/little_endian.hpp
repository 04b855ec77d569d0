// Fields of wire formats in little-endian order, at any alignment.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace landfix::drivers {

static_assert(std::endian::native == std::endian::little, "the loads below are plain copies");

/// An unsigned integer of `Bytes` bytes, least significant byte first. The caller has checked the size.
template <class Integer, std::size_t Bytes = sizeof(Integer)>
[[nodiscard]] inline Integer load_little_endian(const std::byte* bytes) noexcept {
  static_assert(Bytes <= sizeof(Integer));
  Integer value = 0;
  std::memcpy(&value, bytes, Bytes);
  return value;
}

}  // namespace landfix::drivers
