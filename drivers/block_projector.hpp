// The arithmetic that rotating sensors share: a block of slots (u16 range, u8 intensity), one for each
// firing, becomes points. What depends on the beam alone is computed once, what depends on the speed of
// rotation once a packet, and the sine and cosine of the azimuth once a block; what is left for each point is
// in slot_table.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>

#include "drivers/slot_table.hpp"
#include "drivers/sweep.hpp"

namespace landfix::drivers {

/// A point or a direction in the frame of the rotor at azimuth 0: x forward, y left, z up [m].
struct RotorVector {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

/// One firing of a block.
struct FiringSlot {
  double elevation_deg = 0.0;
  double azimuth_offset_deg = 0.0;  ///< clockwise
  RotorVector origin_m{};           ///< where the beam starts
  double turning_time_s = 0.0;  ///< firing time since the block's azimuth was taken: the rotor turns on by it
  double time_s = 0.0;          ///< firing time since the block's earliest firing, >= 0
  std::uint16_t ring = 0;
};

/// While the rotor is taken for where it is to within this, lasers need not be turned on anew: a tenth of the
/// unit in which azimuths come. Encoders are that coarse, so the measured speed flickers by tenths of a
/// percent.
inline constexpr double kLeastTurnRad = 1e-3 * std::numbers::pi / 180.0;

/// From where a sensor measures its ranges.
enum class RangeFrom : std::uint8_t {
  beam_origin,    ///< from where the beam starts
  sensor_centre,  ///< from the origin of the sensor frame, although the beam starts elsewhere
};

/// Returns that are kept. The bounds are in the wire's unit, so that one comparison decides, zero included.
class RangeGate {
 public:
  RangeGate() = default;
  RangeGate(double unit_m, double min_range_m, double max_range_m) noexcept;
  [[nodiscard]] RawBounds bounds() const noexcept { return bounds_; }
  [[nodiscard]] bool admits(std::uint16_t range_raw) const noexcept {
    return range_raw >= bounds_.least && range_raw <= bounds_.most;
  }

 private:
  RawBounds bounds_;
};

/// A block on the wire and what the packet says about it.
struct Block {
  const std::byte* slots = nullptr;  ///< `slot_count` x 3 bytes
  const std::byte* duplicates =
      nullptr;  ///< slots of the other return: equal ranges are dropped; may be null
  std::uint16_t azimuth_centideg = 0;
  float time_s = 0.0F;  ///< of the block's earliest firing, since the start of the sweep
  float unit_m = 0.0F;  ///< of the ranges
};

class BlockProjector {
 public:
  /// `slots`: at most kMaxSlots, in the order of the wire.
  BlockProjector(std::span<const FiringSlot> slots, RangeFrom range_from,
                 ByteOrder byte_order = ByteOrder::little) noexcept;

  /// Speed of rotation, clockwise. Cheap where no laser fires kLeastTurnRad or more from where it did.
  void set_turn_rate(double rad_per_s) noexcept;

  /// Appends the points of a block, in the order of its slots.
  void project(const Block& block, const RangeGate& gate, Sweep& sweep) const noexcept;

 private:
  template <class T>
  using PerSlot = std::array<T, kMaxSlots>;

  void turn_on(double rad_per_s) noexcept;

  double turn_rate_rad_per_s_ = 0.0;
  double longest_turning_time_s_ = 0.0;
  // Of the beam, at rest; the table has it turned on by its firing time.
  PerSlot<RotorVector> direction_{};
  PerSlot<RotorVector> origin_m_{};
  PerSlot<double> turning_time_s_{};
  SlotTable table_;
};

}  // namespace landfix::drivers
