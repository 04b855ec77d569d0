// Frames written byte by byte, so that what reads frames is not tested by what writes them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace landfix::test {

using Bytes = std::vector<std::byte>;

[[nodiscard]] inline Bytes bytes(std::initializer_list<unsigned> values) {
  Bytes result;
  for (const unsigned value : values) result.push_back(static_cast<std::byte>(value));
  return result;
}

[[nodiscard]] inline Bytes operator+(const Bytes& a, const Bytes& b) {
  Bytes result(a.size() + b.size());
  std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), result.begin()));
  return result;
}

/// `count` bytes that differ from their neighbours, and between seeds.
[[nodiscard]] inline Bytes payload(std::size_t count, unsigned seed = 0) {
  Bytes result(count);
  for (std::size_t i = 0; i < count; ++i) {
    result[i] = static_cast<std::byte>((i * 31 + i / 256 + std::size_t{seed} * 77) & 0xFF);
  }
  return result;
}

[[nodiscard]] inline Bytes be16(std::size_t value) {
  return bytes({static_cast<unsigned>(value >> 8 & 0xFF), static_cast<unsigned>(value & 0xFF)});
}

/// From port 2368 to port 2369, without a checksum.
[[nodiscard]] inline Bytes udp(const Bytes& body) {
  return be16(2368) + be16(2369) + be16(body.size() + 8) + be16(0) + body;
}

struct Ipv4Options {
  unsigned protocol = 17;
  unsigned identification = 1;
  std::size_t offset = 0;
  bool more = false;
  Bytes options{};  ///< of the header, a multiple of 4 bytes
  unsigned last_source_byte = 201;
};

/// From 192.168.1.201 to 255.255.255.255.
[[nodiscard]] inline Bytes ipv4(const Bytes& body, const Ipv4Options& with = {}) {
  const std::size_t header = 20 + with.options.size();
  return bytes({0x40U | static_cast<unsigned>(header / 4), 0}) + be16(header + body.size()) +
         be16(with.identification) + be16(with.offset / 8 | (with.more ? 0x2000U : 0U)) +
         bytes({64, with.protocol, 0, 0, 192, 168, 1, with.last_source_byte, 255, 255, 255, 255}) +
         with.options + body;
}

[[nodiscard]] inline Bytes ipv6(const Bytes& body, unsigned next_header = 17) {
  return bytes({0x60, 0, 0, 0}) + be16(body.size()) + bytes({next_header, 64}) + Bytes(32, std::byte{0xFE}) +
         body;
}

[[nodiscard]] inline Bytes ethernet(const Bytes& body, unsigned ether_type = 0x0800) {
  return Bytes(12, std::byte{0x02}) + be16(ether_type) + body;
}

[[nodiscard]] inline bool same(const auto& a, const auto& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace landfix::test
