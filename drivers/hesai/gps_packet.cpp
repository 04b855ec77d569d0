#include "drivers/hesai/gps_packet.hpp"

#include "drivers/civil_time.hpp"
#include "drivers/hesai/wire.hpp"

namespace landfix::drivers::hesai {
namespace {

constexpr std::size_t kPositionAt = 506;
constexpr std::size_t kPulseAt = 507;
constexpr std::byte kValidPosition{'A'};
constexpr std::byte kLockedPulse{1};
constexpr std::uint32_t kMicroseconds = 1'000'000;

/// -1 where there are no two digits.
int two_digits(std::span<const std::byte, kGpsBytes> packet, std::size_t at) noexcept {
  const int units = std::to_integer<int>(packet[at]) - '0';
  const int tens = std::to_integer<int>(packet[at + 1]) - '0';
  const bool digits = units >= 0 && units <= 9 && tens >= 0 && tens <= 9;
  return digits ? 10 * tens + units : -1;
}

}  // namespace

bool is_gps_packet(std::span<const std::byte> payload) noexcept {
  return payload.size() == kGpsBytes && load_little_endian<std::uint16_t>(payload.data()) == kBlockMarker;
}

std::optional<std::int64_t> gps_utc_ns(std::span<const std::byte, kGpsBytes> packet) noexcept {
  if (packet[kPositionAt] != kValidPosition || packet[kPulseAt] != kLockedPulse) return std::nullopt;
  const auto seconds = unix_seconds({.year = 2000 + two_digits(packet, 2),
                                     .month = two_digits(packet, 4),
                                     .day = two_digits(packet, 6),
                                     .hour = two_digits(packet, 12),
                                     .minute = two_digits(packet, 10),
                                     .second = two_digits(packet, 8)});
  const auto microseconds = load_little_endian<std::uint32_t>(&packet[14]);
  if (!seconds || microseconds > kMicroseconds) return std::nullopt;
  return *seconds * 1'000'000'000 + std::int64_t{microseconds} * 1000;
}

}  // namespace landfix::drivers::hesai
