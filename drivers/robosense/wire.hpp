// The packets of RoboSense's rotating sensors, big-endian but for the temperature (RS-LiDAR-16 and -32 User
// Manuals, chapter "Communication Protocol").
//
// Main data stream (MSOP), to port 6699:
//   0        42        142       ...        1142       1242       1246
//   | header | block 0 | block 1 | ... | block 11 | reserved | 00 FF |
//   block: | FF EE | u16 azimuth | 32 x (u16 range, u8 intensity) |
// Device information (DIFOP), to port 7788, about once a second: see device_info.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/block_projector.hpp"

namespace landfix::drivers::robosense {

/// Of either packet: they are told apart by their first bytes, not by port.
inline constexpr std::size_t kPacketBytes = 1248;

inline constexpr std::size_t kBlocks = 12;
inline constexpr std::size_t kBlockSlots = 32;
inline constexpr std::size_t kMaxLasers = 32;
inline constexpr std::size_t kHeaderBytes = 42;
inline constexpr std::size_t kBlockBytes = 4 + kBlockSlots * kSlotBytes;
inline constexpr std::size_t kTailAt = kPacketBytes - 2;
static_assert(kHeaderBytes + kBlocks * kBlockBytes + 4 == kTailAt);

inline constexpr std::uint16_t kBlockFlag = 0xFFEE;
inline constexpr std::uint16_t kDataTail = 0x00FF;
inline constexpr std::uint16_t kDeviceInfoTail = 0x0FF0;

/// Where the time is, ten bytes of either form.
inline constexpr std::size_t kTimeAt = 20;
/// Helios: 0 for units of 0.005 m, 1 for 0.0025 m.
inline constexpr std::size_t kRangeUnitAt = 17;

[[nodiscard]] constexpr std::size_t block_at(std::size_t block) noexcept {
  return kHeaderBytes + block * kBlockBytes;
}

}  // namespace landfix::drivers::robosense
