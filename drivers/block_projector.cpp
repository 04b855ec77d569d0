#include "drivers/block_projector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/centidegrees.hpp"

namespace landfix::drivers {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

double dot(const RotorVector& a, const RotorVector& b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }

std::uint16_t clamped_raw(double raw) noexcept {
  return static_cast<std::uint16_t>(std::clamp(raw, 0.0, 65535.0));
}

}  // namespace

RangeGate::RangeGate(double unit_m, double min_range_m, double max_range_m) noexcept
    // A millionth of a unit, so that a bound that is a whole number of units stays one.
    : bounds_{.least = std::max<std::uint16_t>(1, clamped_raw(std::ceil(min_range_m / unit_m - 1e-6))),
              .most = clamped_raw(std::floor(max_range_m / unit_m + 1e-6))} {}

BlockProjector::BlockProjector(std::span<const FiringSlot> slots, RangeFrom range_from,
                               ByteOrder byte_order) noexcept {
  table_.byte_order = byte_order;
  table_.count = std::min(slots.size(), kMaxSlots);
  for (std::size_t i = 0; i < table_.count; ++i) {
    const FiringSlot& slot = slots[i];
    const double elevation_rad = slot.elevation_deg * kRadPerDeg;
    const double offset_rad = slot.azimuth_offset_deg * kRadPerDeg;
    direction_[i] = {.x = std::cos(elevation_rad) * std::cos(offset_rad),
                     .y = -std::cos(elevation_rad) * std::sin(offset_rad),
                     .z = std::sin(elevation_rad)};
    origin_m_[i] = slot.origin_m;
    turning_time_s_[i] = slot.turning_time_s;
    longest_turning_time_s_ = std::max(longest_turning_time_s_, std::abs(slot.turning_time_s));
    table_.time_s[i] = static_cast<float>(slot.time_s);
    table_.ring[i] = slot.ring;
    table_.direction_z[i] = static_cast<float>(direction_[i].z);
    table_.origin_z_m[i] = static_cast<float>(slot.origin_m.z);
    if (range_from == RangeFrom::sensor_centre) {
      const double lead_m = dot(slot.origin_m, direction_[i]);
      table_.lead_m[i] = static_cast<float>(lead_m);
      table_.square_m2[i] = static_cast<float>(lead_m * lead_m - dot(slot.origin_m, slot.origin_m));
    }
  }
  turn_on(0.0);
}

void BlockProjector::set_turn_rate(double rad_per_s) noexcept {
  if (std::abs(rad_per_s - turn_rate_rad_per_s_) * longest_turning_time_s_ < kLeastTurnRad) return;
  turn_on(rad_per_s);
}

void BlockProjector::turn_on(double rad_per_s) noexcept {
  turn_rate_rad_per_s_ = rad_per_s;
  for (std::size_t i = 0; i < table_.count; ++i) {
    // Below 1 deg: the series are exact to float.
    const double angle = rad_per_s * turning_time_s_[i];
    const double cosine = 1.0 - angle * angle / 2.0;
    const double sine = angle - angle * angle * angle / 6.0;
    table_.direction_x[i] = static_cast<float>(direction_[i].x * cosine + direction_[i].y * sine);
    table_.direction_y[i] = static_cast<float>(direction_[i].y * cosine - direction_[i].x * sine);
    table_.origin_x_m[i] = static_cast<float>(origin_m_[i].x * cosine + origin_m_[i].y * sine);
    table_.origin_y_m[i] = static_cast<float>(origin_m_[i].y * cosine - origin_m_[i].x * sine);
  }
}

void BlockProjector::project(const Block& block, const RangeGate& gate, Sweep& sweep) const noexcept {
  const SineCosine azimuth = sine_cosine(block.azimuth_centideg);
  const SlotBlock slots{.slots = block.slots,
                        .duplicates = block.duplicates,
                        .sine = static_cast<float>(azimuth.sine),
                        .cosine = static_cast<float>(azimuth.cosine),
                        .time_s = block.time_s,
                        .unit_m = block.unit_m};
  if (const auto room = sweep.unused(); room.size() >= table_.count) {
    const SlotPoints written = project_slots(table_, slots, gate.bounds(), room);
    sweep.take(written.count, written.latest_s);
    return;
  }
  PerSlot<Point> points;  // what does not fit is counted
  const SlotPoints written = project_slots(table_, slots, gate.bounds(), points);
  for (const Point& point : std::span(points).first(written.count)) sweep.push(point);
}

}  // namespace landfix::drivers
