// The checksum of IPv4 and UDP headers (RFC 1071): the ones' complement of a ones' complement sum.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "platform/big_endian.hpp"

namespace landfix::platform {

/// The sum so far; pieces added one after the other must each have an even size, but for the last.
class InternetChecksum {
 public:
  constexpr void add(std::span<const std::byte> bytes) noexcept {
    const std::size_t even = bytes.size() - bytes.size() % 2;
    for (std::size_t i = 0; i < even; i += 2) sum_ += load_be16(bytes, i);
    if (even != bytes.size()) sum_ += std::to_integer<std::uint64_t>(bytes.back()) << 8;
  }
  constexpr void add(std::uint32_t value) noexcept { sum_ += (value >> 16) + (value & 0xFFFF); }

  [[nodiscard]] constexpr std::uint16_t value() const noexcept {
    std::uint64_t folded = sum_;
    while (folded > 0xFFFF) folded = (folded & 0xFFFF) + (folded >> 16);
    return static_cast<std::uint16_t>(~folded & 0xFFFF);
  }

 private:
  std::uint64_t sum_ = 0;
};

inline constexpr std::uint8_t kProtocolUdp = 17;

/// Over a whole UDP datagram over IPv4, its header and the pseudo-header included (RFC 768): 0 if the
/// checksum within is right; what belongs into its field if that field is 0.
[[nodiscard]] constexpr std::uint16_t udp_checksum(std::uint32_t source_address,
                                                   std::uint32_t destination_address,
                                                   std::span<const std::byte> datagram) noexcept {
  InternetChecksum checksum;
  checksum.add(source_address);
  checksum.add(destination_address);
  checksum.add(std::uint32_t{kProtocolUdp});
  checksum.add(static_cast<std::uint32_t>(datagram.size()));
  checksum.add(datagram);
  return checksum.value();
}

}  // namespace landfix::platform
