#include "drivers/block_projector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/big_endian.hpp"
#include "drivers/little_endian.hpp"

namespace landfix::drivers {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

double dot(const RotorVector& a, const RotorVector& b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }

std::uint16_t clamped_raw(double raw) noexcept {
  return static_cast<std::uint16_t>(std::clamp(raw, 0.0, 65535.0));
}

/// The ranges of a block's slots, with the choice of the order outside the loop.
void load_ranges(const std::byte* slots, ByteOrder order, std::span<std::uint16_t> range_raw) noexcept {
  const std::size_t count = range_raw.size();
  if (order == ByteOrder::big) {
    for (std::size_t i = 0; i < count; ++i)
      range_raw[i] = load_big_endian<std::uint16_t>(slots + i * kSlotBytes);
  } else {
    for (std::size_t i = 0; i < count; ++i)
      range_raw[i] = load_little_endian<std::uint16_t>(slots + i * kSlotBytes);
  }
}

}  // namespace

RangeGate::RangeGate(double unit_m, double min_range_m, double max_range_m) noexcept
    // A millionth of a unit, so that a bound that is a whole number of units stays one.
    : least_raw_(std::max<std::uint16_t>(1, clamped_raw(std::ceil(min_range_m / unit_m - 1e-6)))),
      most_raw_(clamped_raw(std::floor(max_range_m / unit_m + 1e-6))) {}

BlockProjector::BlockProjector(std::span<const FiringSlot> slots, RangeFrom range_from,
                               ByteOrder byte_order) noexcept
    : slot_count_(std::min(slots.size(), kMaxSlots)), byte_order_(byte_order) {
  for (std::size_t i = 0; i < slot_count_; ++i) {
    const FiringSlot& slot = slots[i];
    const double elevation_rad = slot.elevation_deg * kRadPerDeg;
    const double offset_rad = slot.azimuth_offset_deg * kRadPerDeg;
    direction_[i] = {.x = std::cos(elevation_rad) * std::cos(offset_rad),
                     .y = -std::cos(elevation_rad) * std::sin(offset_rad),
                     .z = std::sin(elevation_rad)};
    origin_m_[i] = slot.origin_m;
    turning_time_s_[i] = slot.turning_time_s;
    time_s_[i] = static_cast<float>(slot.time_s);
    ring_[i] = slot.ring;
    direction_z_[i] = static_cast<float>(direction_[i].z);
    origin_z_m_[i] = static_cast<float>(slot.origin_m.z);
    if (range_from == RangeFrom::sensor_centre) {
      const double lead_m = dot(slot.origin_m, direction_[i]);
      lead_m_[i] = static_cast<float>(lead_m);
      square_m2_[i] = static_cast<float>(lead_m * lead_m - dot(slot.origin_m, slot.origin_m));
    }
  }
  turn_rate_rad_per_s_ = 1.0;  // anything but 0, which is to be set
  set_turn_rate(0.0);
}

void BlockProjector::set_turn_rate(double rad_per_s) noexcept {
  if (std::abs(rad_per_s - turn_rate_rad_per_s_) <= 1e-4 * std::abs(turn_rate_rad_per_s_)) return;
  turn_rate_rad_per_s_ = rad_per_s;
  for (std::size_t i = 0; i < slot_count_; ++i) {
    // Below 1 deg: the series are exact to float.
    const double angle = rad_per_s * turning_time_s_[i];
    const double cosine = 1.0 - angle * angle / 2.0;
    const double sine = angle - angle * angle * angle / 6.0;
    direction_x_[i] = static_cast<float>(direction_[i].x * cosine + direction_[i].y * sine);
    direction_y_[i] = static_cast<float>(direction_[i].y * cosine - direction_[i].x * sine);
    origin_x_m_[i] = static_cast<float>(origin_m_[i].x * cosine + origin_m_[i].y * sine);
    origin_y_m_[i] = static_cast<float>(origin_m_[i].y * cosine - origin_m_[i].x * sine);
  }
}

void BlockProjector::project(const Block& block, const RangeGate& gate, Sweep& sweep) const noexcept {
  const std::size_t count = slot_count_;
  PerSlot<std::uint16_t> range_raw;
  load_ranges(block.slots, byte_order_, std::span(range_raw).first(count));
  if (block.duplicates != nullptr) {
    PerSlot<std::uint16_t> other_raw;
    load_ranges(block.duplicates, byte_order_, std::span(other_raw).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      if (other_raw[i] == range_raw[i]) range_raw[i] = 0;
    }
  }

  const double azimuth_rad = block.azimuth_centideg * (0.01 * kRadPerDeg);
  const auto cosine = static_cast<float>(std::cos(azimuth_rad));
  const auto sine = static_cast<float>(std::sin(azimuth_rad));
  alignas(32) PerSlot<float> x;
  alignas(32) PerSlot<float> y;
  alignas(32) PerSlot<float> z;
  for (std::size_t i = 0; i < count; ++i) {
    const float range_m = static_cast<float>(range_raw[i]) * block.unit_m;
    const float along_m = std::sqrt(std::max(range_m * range_m + square_m2_[i], 0.0F)) - lead_m_[i];
    const float rotor_x = origin_x_m_[i] + along_m * direction_x_[i];
    const float rotor_y = origin_y_m_[i] + along_m * direction_y_[i];
    x[i] = rotor_x * cosine + rotor_y * sine;
    y[i] = rotor_y * cosine - rotor_x * sine;
    z[i] = origin_z_m_[i] + along_m * direction_z_[i];
  }

  for (std::size_t i = 0; i < count; ++i) {
    if (!gate.admits(range_raw[i])) continue;
    const auto intensity = std::to_integer<std::uint8_t>(block.slots[i * kSlotBytes + 2]);
    sweep.push({.x = x[i],
                .y = y[i],
                .z = z[i],
                .intensity = static_cast<float>(intensity),
                .time_s = block.time_s + time_s_[i],
                .ring = ring_[i]});
  }
}

}  // namespace landfix::drivers
