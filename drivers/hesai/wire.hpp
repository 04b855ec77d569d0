// The data packet of the Pandar64 (Pandar64 User Manual).
//
//   0        8             ...            tail        +22        +26
//   | header | block 0 | block 1 | ... | tail       | sequence |   the sequence where the size says so
//   block: | u16 azimuth | 64 x (u16 range, u8 intensity) |
#pragma once

#include <cstddef>
#include <cstdint>

#include "drivers/block_projector.hpp"
#include "drivers/little_endian.hpp"

namespace landfix::drivers::hesai {

inline constexpr std::size_t kPandar64Lasers = 64;
inline constexpr std::size_t kMaxBlocks = 7;

/// Everything on the wire is bytes: no alignment is assumed, fields are read by load_little_endian.
struct WireHeader {
  std::byte marker[2];  ///< EE FF
  std::byte laser_count;
  std::byte block_count;    ///< 6, or 7 in a variant
  std::byte first_return;   ///< 0 in recorded dual packets, whatever the manual says: not to be used
  std::byte range_unit_mm;  ///< 4
  std::byte reserved[2];
};
static_assert(sizeof(WireHeader) == 8);

struct WireBlock {
  std::byte azimuth_centideg[2];
  std::byte slots[kPandar64Lasers * kSlotBytes];
};
static_assert(sizeof(WireBlock) == 194);

struct WireTail {
  std::byte status[8];
  std::byte motor_rpm[2];
  std::byte microseconds[4];  ///< within the second
  std::byte return_mode;
  std::byte factory;
  std::byte year;  ///< since 2000, or since 1900 where it is 100 or more
  std::byte month;
  std::byte day;
  std::byte hour;
  std::byte minute;
  std::byte second;
};
static_assert(sizeof(WireTail) == 22);
static_assert(alignof(WireHeader) == 1 && alignof(WireBlock) == 1 && alignof(WireTail) == 1);

inline constexpr std::size_t kSequenceBytes = 4;

/// Size of a packet without the sequence number.
[[nodiscard]] constexpr std::size_t packet_bytes(std::size_t blocks) noexcept {
  return sizeof(WireHeader) + blocks * sizeof(WireBlock) + sizeof(WireTail);
}
static_assert(packet_bytes(6) == 1194 && packet_bytes(7) == 1388);

/// The byte `return_mode`.
enum class ReturnMode : std::uint8_t { strongest = 0x37, last = 0x38, dual = 0x39 };

}  // namespace landfix::drivers::hesai
