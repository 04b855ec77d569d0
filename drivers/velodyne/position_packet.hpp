// The position packet: the sensor's clock beside what the GPS receiver at it says (VLP-16 User Manual 63-9243
// Rev D, section 9.3.3; the HDL-32E's has the same fields at the same places).
//
//   0     | 198             | 202   | 206                 | 512
//   | ... | u32 us of hour  | pulse | NMEA sentence, CR LF, zeros |
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/decoder.hpp"
#include "drivers/sweep_builder.hpp"

namespace landfix::drivers::velodyne {

inline constexpr std::size_t kPositionBytes = 512;

/// Of the receiver's pulse a second, to which the sensor's clock is locked.
enum class PulseState : std::uint8_t { absent = 0, synchronising = 1, locked = 2, error = 3 };

/// What the receiver says of its place, WGS 84.
struct PositionFix {
  double latitude_deg = 0.0;   ///< north is positive
  double longitude_deg = 0.0;  ///< east is positive
  double speed_mps = 0.0;
  double course_deg = 0.0;  ///< clockwise from north
};

struct PositionPacket {
  std::uint32_t top_of_hour_us = 0;
  PulseState pulse = PulseState::absent;
  /// Time of the packet by the sensor's clock, Unix nanoseconds UTC. Known if the pulse is locked and the
  /// receiver vouches for its time; the hour and the date are the sentence's.
  std::optional<std::int64_t> utc_ns;
  std::optional<PositionFix> fix;  ///< if the receiver vouches for it
};

/// Reads the recommended minimum sentence (GPRMC, or of another talker) where it is whole and its checksum
/// fits. Nothing if the packet's size or time is none of a position packet's.
[[nodiscard]] std::optional<PositionPacket> parse_position_packet(
    std::span<const std::byte> payload) noexcept;

/// What a decoder does with one: its clock learns UTC, where the packet knows it, and `fix` becomes the
/// packet's.
[[nodiscard]] DecodeStatus read_position(const Packet& packet, SweepBuilder& builder,
                                         std::optional<PositionFix>& fix) noexcept;

}  // namespace landfix::drivers::velodyne
