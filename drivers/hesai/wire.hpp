// What the data packets of the Pandar40P and the Pandar64 share (user manuals, section 3.1).
//
//   0        8         ...           tail   +22        +26
//   | header | block 0 | block 1 ... | tail | sequence |   the sequence where the size says so
//   block: | FF EE | u16 azimuth | lasers x (u16 range, u8 intensity) |
//
// The header is on the Pandar64 alone, FF EE before the azimuths on the Pandar40P alone.
#pragma once

#include <cstddef>
#include <cstdint>

#include "drivers/little_endian.hpp"

namespace landfix::drivers::hesai {

/// FF EE, before each block of a packet without header and in front of a GPS packet.
inline constexpr std::uint16_t kBlockMarker = 0xEEFF;
/// EE FF, in front of a packet with header.
inline constexpr std::uint16_t kHeaderMarker = 0xFFEE;

/// Everything on the wire is bytes: no alignment is assumed, fields are read by load_little_endian.
struct WireHeader {
  std::byte marker[2];
  std::byte laser_count;  ///< 64; newer protocols say their version here
  std::byte block_count;
  std::byte first_return;   ///< 0 in recorded dual packets, whatever the manual says: not to be used
  std::byte range_unit_mm;  ///< 4
  std::byte reserved[2];
};
static_assert(sizeof(WireHeader) == 8);

struct WireTail {
  std::byte status[8];  ///< among it at 5: 1 if too hot, the sensor stops 60 s later
  std::byte motor_rpm[2];
  std::byte microseconds[4];  ///< within the second
  std::byte return_mode;
  std::byte factory;
  std::byte date[6];  ///< year, month, day, hour, minute, second; see unix_seconds_of
};
static_assert(sizeof(WireTail) == 22);
static_assert(alignof(WireHeader) == 1 && alignof(WireTail) == 1);

inline constexpr std::size_t kAzimuthBytes = 2;
inline constexpr std::size_t kSequenceBytes = 4;

/// The byte `return_mode`; the other codes are of newer models.
enum class ReturnMode : std::uint8_t { strongest = 0x37, last = 0x38, dual = 0x39 };

}  // namespace landfix::drivers::hesai
