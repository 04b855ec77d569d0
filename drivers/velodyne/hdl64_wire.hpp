// How the blocks of an HDL-64E lie in its packets. The packet is that of all Velodyne sensors
// (drivers/velodyne/wire.hpp), but nothing in it names the model: the order of the blocks does.
//
//   S2, S3         upper lower  upper lower  upper lower ...    six firings, a pair has one azimuth
//   S3, two returns  upper lower upper lower  ...               three firings: strongest pair, last pair
//   S1             lower  upper  upper  upper  lower ...        one after the other, each has its azimuth
//
// The S1's order is that of recorded units: their upper block fires three times as often as the lower one.
// The last six bytes of their packets are text ("25 DegC"), no time and no status.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/sweep_cutter.hpp"
#include "drivers/velodyne/wire.hpp"

namespace landfix::drivers::velodyne {

inline constexpr std::uint16_t kUpperBlock = 0xEEFF;
inline constexpr std::uint16_t kLowerBlock = 0xDDFF;

enum class Hdl64Layout : std::uint8_t { single, dual, s1 };

[[nodiscard]] inline std::uint16_t hdl64_azimuth(std::span<const std::byte> payload,
                                                 std::size_t block) noexcept {
  return load_little_endian<std::uint16_t>(payload.data() + block * sizeof(WireBlock) + 2);
}

/// Nothing where the payload is no packet of an HDL-64E.
[[nodiscard]] inline std::optional<Hdl64Layout> hdl64_layout(std::span<const std::byte> payload) noexcept {
  if (payload.size() != sizeof(WirePacket)) return std::nullopt;
  bool is_alternating = true;
  bool is_s1 = true;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const std::uint16_t flag = flag_of_block(payload, b);
    is_alternating = is_alternating && flag == (b % 2 == 0 ? kUpperBlock : kLowerBlock);
    is_s1 = is_s1 && flag == (b % 4 == 0 ? kLowerBlock : kUpperBlock);
  }
  if (is_s1) return Hdl64Layout::s1;
  if (!is_alternating) return std::nullopt;
  // A rotor that stands still shows the same: then it does not matter.
  bool is_dual = true;
  for (std::size_t b = 0; b < kBlocks; b += 4) {
    is_dual = is_dual && hdl64_azimuth(payload, b) == hdl64_azimuth(payload, b + 2);
  }
  return is_dual ? Hdl64Layout::dual : Hdl64Layout::single;
}

}  // namespace landfix::drivers::velodyne
