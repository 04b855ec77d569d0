// The status bytes with which an HDL-64E S2 sends its calibration, a packet each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace landfix::test {

struct Hdl64Status {
  std::uint8_t type;
  std::uint8_t value;
};

/// A set of an S2 whose lasers differ in their elevation alone, as the values that packets bring.
inline std::vector<Hdl64Status> sent_set() {
  std::vector<std::uint8_t> bytes(1820);
  constexpr std::string_view kMarker = "UNIT#";
  for (std::size_t i = 0; i < kMarker.size(); ++i) bytes[i] = static_cast<std::uint8_t>(kMarker[i]);
  for (std::size_t laser = 0; laser < 64; ++laser) {
    const std::size_t at = 7 + 28 * laser;
    bytes[at] = static_cast<std::uint8_t>(laser);
    const int elevation_centideg = -2000 + 35 * static_cast<int>(laser);
    bytes[at + 1] = static_cast<std::uint8_t>(elevation_centideg & 0xFF);
    bytes[at + 2] = static_cast<std::uint8_t>(elevation_centideg >> 8 & 0xFF);
    bytes[at + 5] = 0x78;  // 1400 mm
    bytes[at + 6] = 0x05;
    bytes[at + 17] = 15;
    bytes[at + 20] = 255;
  }
  bytes[1817] = 0xA8;
  bytes[1818] = 0x1C;
  bytes[1819] = 0x07;
  std::vector<Hdl64Status> sent;
  constexpr std::string_view kLetters = "HMSDNYGTV";
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i % 7 == 0) {
      for (const char letter : kLetters) sent.push_back({static_cast<std::uint8_t>(letter), 'U'});
    }
    sent.push_back({static_cast<std::uint8_t>('1' + i % 7), bytes[i]});
  }
  return sent;
}

}  // namespace landfix::test
