// The inner loops of a block: slots on the wire become points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/point.hpp"
#include "drivers/slot_columns.hpp"

namespace landfix::drivers {

inline constexpr std::size_t kMaxSlots = 64;

/// Returns that are kept, in the wire's unit, so that one comparison decides, zero included.
struct RawBounds {
  std::uint16_t least = 1;  // 0 is no return
  std::uint16_t most = 0xFFFF;
};

/// What the beams have in common with those of the block before.
struct SlotTable {
  template <class T>
  using PerSlot = std::array<T, kMaxSlots>;

  std::size_t count = 0;  ///< at most kMaxSlots
  ByteOrder byte_order = ByteOrder::little;
  // Where a beam starts and points in the frame of the rotor, at its firing time.
  alignas(64) PerSlot<float> origin_x_m{};
  alignas(64) PerSlot<float> origin_y_m{};
  alignas(64) PerSlot<float> origin_z_m{};
  alignas(64) PerSlot<float> direction_x{};
  alignas(64) PerSlot<float> direction_y{};
  alignas(64) PerSlot<float> direction_z{};
  // A range d from the sensor's centre is sqrt(d^2 + square) - lead along the beam; 0 from the beam's origin.
  alignas(64) PerSlot<float> square_m2{};
  alignas(64) PerSlot<float> lead_m{};
  alignas(64) PerSlot<float> time_s{};  ///< since the block's earliest firing
  alignas(64) PerSlot<std::uint32_t> ring{};
};

/// One block and where the rotor was.
struct SlotBlock {
  const std::byte* slots = nullptr;       ///< `count` x kSlotBytes
  const std::byte* duplicates = nullptr;  ///< of the other return: equal ranges are left out; may be null
  float sine = 0.0F;                      ///< of the azimuth
  float cosine = 1.0F;
  float time_s = 0.0F;  ///< >= 0
  float unit_m = 0.0F;
};

/// Writes the points of a block in the order of its slots. `points` has room for `table.count`, whose rest is
/// overwritten too. Bytes between the fields are zero. The result is the same to the bit on every processor.
[[nodiscard]] SlotPoints project_slots(const SlotTable& table, const SlotBlock& block, RawBounds bounds,
                                       std::span<Point> points) noexcept;

}  // namespace landfix::drivers
