// The data packet of Velodyne's rotating sensors (VLP-16 User Manual 63-9243 Rev D, section 9.3).
//
//   0            100           ...  1100          1200        1204    1205   1206
//   | block 0    | block 1     | ...| block 11    | u32 time  | mode  | product |
//   block: | u16 flag | u16 azimuth | 32 x (u16 range, u8 intensity) |
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/block_projector.hpp"
#include "drivers/little_endian.hpp"

namespace landfix::drivers::velodyne {

inline constexpr std::size_t kBlocks = 12;
inline constexpr std::size_t kBlockSlots = 32;
inline constexpr std::uint16_t kBlockFlag = 0xEEFF;
/// Lasers 0 to 31, 32 to 63, 64 to 95, 96 to 127: the flag of a block says which.
inline constexpr std::array<std::uint16_t, 4> kBankFlags{0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
/// Some firmware counts on for some milliseconds before it returns to zero at the full hour.
inline constexpr std::uint32_t kLatestTopOfHourUs = 3'601'000'000;

/// The byte that names a VLS-128 or an Alpha Prime, and the one that the VLP-16's manual lists for them.
inline constexpr std::byte kVls128Product{0xA1};
inline constexpr std::byte kVls128ProductOfTheManual{0x63};

/// Everything on the wire is bytes: no alignment is assumed, fields are read by load_little_endian.
struct WireBlock {
  std::byte flag[2];
  std::byte azimuth_centideg[2];
  std::byte slots[kBlockSlots * kSlotBytes];
};
static_assert(sizeof(WireBlock) == 100);

struct WirePacket {
  WireBlock blocks[kBlocks];
  std::byte top_of_hour_us[4];
  std::byte return_mode;
  std::byte product;
};
static_assert(sizeof(WirePacket) == 1206);
static_assert(alignof(WirePacket) == 1);

/// The flag of a block of a payload that has the size of a packet.
[[nodiscard]] inline std::uint16_t flag_of_block(std::span<const std::byte> payload,
                                                 std::size_t block) noexcept {
  return load_little_endian<std::uint16_t>(payload.data() + block * sizeof(WireBlock));
}

/// The byte `return_mode`.
enum class ReturnMode : std::uint8_t {
  unknown = 0x00,  ///< firmware before 2016 leaves both factory bytes zero
  strongest = 0x37,
  last = 0x38,
  dual = 0x39,
  triple = 0x3A,                ///< Alpha Prime
  dual_with_confidence = 0x3B,  ///< Alpha Prime
};

}  // namespace landfix::drivers::velodyne
