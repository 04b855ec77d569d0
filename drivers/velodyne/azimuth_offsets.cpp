#include "drivers/velodyne/azimuth_offsets.hpp"

#include <cmath>
#include <string>

#include "drivers/calibration_text.hpp"

namespace landfix::drivers::velodyne {
namespace {

/// What is beyond is not a unit's residual but another convention.
constexpr double kMaxOffsetDeg = 2.0;

}  // namespace

std::vector<Beam> parse_azimuth_offsets(std::span<const std::byte> file, std::string_view name,
                                        std::span<const Beam> table) {
  std::vector<Beam> beams(table.begin(), table.end());
  std::vector<bool> seen(beams.size(), false);
  std::string_view text = to_text(file);
  std::size_t count = 0;
  for (std::size_t line = 1; !text.empty(); ++line) {
    std::string_view row = trimmed(take_until(text, '\n'));
    if (row.empty()) continue;
    const auto id = to_number(take_until(row, ','));
    const auto offset_deg = to_number(row);
    if (line == 1 && !id) continue;  // the names of the columns
    if (!id || !offset_deg) fail(name, line, "expected laser_id,azimuth_offset_deg");
    const std::size_t laser = to_index(*id, 0, beams.size(), "laser_id", name, line);
    if (seen[laser]) fail(name, line, "laser " + std::to_string(laser) + " is given twice");
    if (std::abs(*offset_deg) > kMaxOffsetDeg) {
      fail(name, line, "offset is beyond 2 degrees: give what is to be added to the model's own");
    }
    seen[laser] = true;
    beams[laser].azimuth_offset_deg += *offset_deg;
    ++count;
  }
  if (count == 0) fail(name, 1, "no line with laser_id,azimuth_offset_deg");
  return beams;
}

}  // namespace landfix::drivers::velodyne
