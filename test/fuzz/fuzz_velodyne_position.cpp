#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/velodyne/position_packet.hpp"

/// The input is the packet from the clock on; a checksum that fits is put behind every sentence, which chance
/// would hardly find.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::byte> payload(512);
  const auto input = std::as_bytes(std::span(data, size));
  std::copy_n(input.begin(), std::min(input.size(), payload.size() - 198), payload.begin() + 198);
  unsigned sum = 0;
  for (std::size_t at = 207; at + 3 < payload.size(); ++at) {
    if (payload[at] == std::byte{'*'}) {
      payload[at + 1] = static_cast<std::byte>("0123456789ABCDEF"[sum / 16]);
      payload[at + 2] = static_cast<std::byte>("0123456789ABCDEF"[sum % 16]);
      break;
    }
    sum ^= std::to_integer<unsigned>(payload[at]);
  }
  const auto packet = landfix::drivers::velodyne::parse_position_packet(payload);
  if (packet && packet->fix &&
      !(std::abs(packet->fix->latitude_deg) <= 90.0 && std::abs(packet->fix->longitude_deg) <= 180.0)) {
    __builtin_trap();
  }
  return 0;
}
