// What tells the models of the family apart: the shape of their packets, and when and where they fire.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/block_projector.hpp"
#include "drivers/hesai/wire.hpp"

namespace landfix::drivers::hesai {

inline constexpr std::size_t kMaxBlocks = 10;

struct PandarLayout {
  std::size_t lasers = 0;
  std::size_t header_bytes = 0;         ///< 0: the packet begins with its first block
  std::size_t block_marker_bytes = 0;   ///< before the azimuth of each block
  std::array<std::size_t, 2> blocks{};  ///< in a packet; which of them, the header says
  unsigned range_unit_mm = 0;           ///< 0: the header says
  std::int64_t block_ns = 0;            ///< from one firing of all lasers to the next
  std::int64_t last_block_ns = 0;       ///< end of the last block, since the packet's time
  RotorVector optical_centre_m;         ///< where the beams start, beside the axis of rotation

  [[nodiscard]] constexpr std::size_t block_bytes() const noexcept {
    return block_marker_bytes + kAzimuthBytes + lasers * kSlotBytes;
  }
  /// Where the marker of a block is, or where it would be.
  [[nodiscard]] constexpr std::size_t block_at(std::size_t block) const noexcept {
    return header_bytes + block * block_bytes();
  }
  /// Size of a packet without the sequence number.
  [[nodiscard]] constexpr std::size_t packet_bytes(std::size_t block_count) const noexcept {
    return block_at(block_count) + sizeof(WireTail);
  }
};

/// Times: appendix II of the manuals. The optical centre is the maker's own reader's, confirmed by the walls
/// of a recording.
inline constexpr PandarLayout kPandar64{.lasers = 64,
                                        .header_bytes = sizeof(WireHeader),
                                        .blocks = {6, 7},  // 7 in a variant
                                        .block_ns = 55'560,
                                        .last_block_ns = -42'580,
                                        .optical_centre_m = {.x = 0.03873, .y = 0.012}};
static_assert(kPandar64.block_bytes() == 194);
static_assert(kPandar64.packet_bytes(6) == 1194 && kPandar64.packet_bytes(7) == 1388);

inline constexpr PandarLayout kPandar40p{.lasers = 40,
                                         .block_marker_bytes = sizeof(kBlockMarker),
                                         .blocks = {10, 10},
                                         .range_unit_mm = 4,
                                         .block_ns = 55'560,
                                         .last_block_ns = -28'580,
                                         .optical_centre_m = {.x = 0.03873, .y = 0.012}};
static_assert(kPandar40p.block_bytes() == 124);
static_assert(kPandar40p.packet_bytes(10) == 1262);  // 1256 is the old Pandar40, whose tail is another

/// Of the model with that many lasers.
[[nodiscard]] constexpr const PandarLayout& layout_of(std::size_t lasers) noexcept {
  return lasers == kPandar40p.lasers ? kPandar40p : kPandar64;
}

}  // namespace landfix::drivers::hesai
