#include "drivers/slot_table.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/widest.hpp"

namespace landfix::drivers {
namespace {

/// `count` is that of the table: where the caller writes a number, the loops are made for it.
[[gnu::always_inline]] inline SlotPoints project(const SlotTable& table, std::size_t count,
                                                 const SlotBlock& block, RawBounds bounds,
                                                 std::span<Point> points) noexcept {
  SlotColumns<kMaxSlots> columns;
  read_slots(block.slots, block.duplicates, count, table.byte_order, columns);
  auto& [words, x, y, z, intensity, kept] = columns;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t range_raw = range_of(words[i]);
    const float range_m = static_cast<float>(static_cast<std::int32_t>(range_raw)) * block.unit_m;
    const float along_m = std::sqrt(std::max(range_m * range_m + table.square_m2[i], 0.0F)) - table.lead_m[i];
    const float rotor_x = table.origin_x_m[i] + along_m * table.direction_x[i];
    const float rotor_y = table.origin_y_m[i] + along_m * table.direction_y[i];
    x[i] = rotor_x * block.cosine + rotor_y * block.sine;
    y[i] = rotor_y * block.cosine - rotor_x * block.sine;
    z[i] = table.origin_z_m[i] + along_m * table.direction_z[i];
    intensity[i] = intensity_of(words[i]);
    kept[i] = range_raw >= bounds.least && range_raw <= bounds.most ? 1 : 0;
  }
  return write_points(columns, count, block.time_s, table.time_s.data(), table.ring.data(), points);
}

}  // namespace

LANDFIX_WIDEST SlotPoints project_slots(const SlotTable& table, const SlotBlock& block, RawBounds bounds,
                                        std::span<Point> points) noexcept {
  switch (table.count) {
    case 32:
      return project(table, 32, block, bounds, points);
    default:
      return project(table, table.count, block, bounds, points);
  }
}

}  // namespace landfix::drivers
