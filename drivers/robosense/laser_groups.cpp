#include "drivers/robosense/laser_groups.hpp"

#include <cstring>

namespace landfix::drivers::robosense {
namespace {

constexpr std::byte kGroupBit{0x80};
constexpr std::size_t kHalfBytes = kBlockSlots / 2 * kSlotBytes;

constexpr std::size_t kTooManyToBeFar = 8;

bool is_flagged(const std::byte* slot) noexcept { return (slot[0] & kGroupBit) != std::byte{0}; }

bool is_empty(const std::byte* slot) noexcept {
  return (slot[0] & ~kGroupBit) == std::byte{0} && slot[1] == std::byte{0};
}

}  // namespace

LaserGroup group_of(const std::byte* slots) noexcept {
  std::size_t returns = 0;
  std::size_t flagged = 0;
  for (std::size_t i = 0; i < kBlockSlots; ++i) {
    const std::byte* const slot = slots + i * kSlotBytes;
    if (is_empty(slot)) continue;
    ++returns;
    if (is_flagged(slot)) ++flagged;
  }
  if (returns == 0) return LaserGroup::none;
  if (flagged == 0) return LaserGroup::a;
  return flagged == returns ? LaserGroup::b : LaserGroup::mixed;
}

bool seems_of_group_b(const std::byte* slots) noexcept {
  std::size_t flagged = 0;
  for (std::size_t i = 0; i < kBlockSlots; ++i) {
    const std::byte* const slot = slots + i * kSlotBytes;
    if (is_empty(slot)) continue;
    if (!is_flagged(slot)) return false;
    ++flagged;
  }
  return flagged >= kTooManyToBeFar;
}

BlockSlotBytes in_order(const std::byte* slots) noexcept {
  BlockSlotBytes ordered;
  const std::size_t first = group_of(slots) == LaserGroup::b ? kHalfBytes : 0;
  std::memcpy(ordered.data(), slots + first, kHalfBytes);
  std::memcpy(ordered.data() + kHalfBytes, slots + (kHalfBytes - first), kHalfBytes);
  for (std::size_t i = 0; i < kBlockSlots; ++i) ordered[i * kSlotBytes] &= ~kGroupBit;
  return ordered;
}

}  // namespace landfix::drivers::robosense
