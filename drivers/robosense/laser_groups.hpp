// The RS-LiDAR-32's firmware of 2018: ranges in centimetres, and bit 15 of each says which half of the block
// is which. Group A: in order; group B: the halves of sixteen lasers are swapped.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/robosense/wire.hpp"

namespace landfix::drivers::robosense {

inline constexpr double kCentimetre = 0.01;

enum class LaserGroup : std::uint8_t {
  none,   ///< the block is empty
  a,      ///< bit 15 is clear in all returns
  b,      ///< set in all
  mixed,  ///< then bit 15 is part of the range
};

/// What bit 15 says in the slots of a block.
[[nodiscard]] LaserGroup group_of(const std::byte* slots) noexcept;

/// Whether a block of ranges in half centimetres must be of the other kind: so many returns have bit 15 as
/// never are all beyond 163.84 m.
[[nodiscard]] bool seems_of_group_b(const std::byte* slots) noexcept;

using BlockSlotBytes = std::array<std::byte, kBlockSlots * kSlotBytes>;

/// The block as today's firmware would send it, but for the unit: in the order of group A, without the bit.
[[nodiscard]] BlockSlotBytes in_order(const std::byte* slots) noexcept;

}  // namespace landfix::drivers::robosense
