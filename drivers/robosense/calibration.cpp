#include "drivers/robosense/calibration.hpp"

#include <cmath>
#include <string>

#include "drivers/calibration_text.hpp"

namespace landfix::drivers::robosense {
namespace {

constexpr double kMaxAngleDeg = 90.0;

Beam parse_line(std::string_view text, std::string_view name, std::size_t line) {
  const auto vertical_deg = to_number(take_until(text, ','));
  const auto horizontal_deg = to_number(text);
  if (!vertical_deg || !horizontal_deg) {
    fail(name, line, "not two numbers: expected vertical,horizontal in degrees, a line a laser");
  }
  if (std::abs(*vertical_deg) > kMaxAngleDeg || std::abs(*horizontal_deg) > kMaxAngleDeg) {
    fail(name, line, "angle is beyond 90 degrees: expected vertical,horizontal in degrees");
  }
  return {.elevation_deg = *vertical_deg, .azimuth_offset_deg = *horizontal_deg};
}

}  // namespace

std::vector<Beam> parse_calibration(std::span<const std::byte> file, std::string_view name,
                                    std::size_t lasers) {
  std::string_view text = to_text(file);
  std::vector<Beam> beams;
  std::size_t line = 0;
  while (!text.empty()) {
    ++line;
    const std::string_view row = trimmed(take_until(text, '\n'));
    if (row.empty()) continue;
    if (beams.size() == lasers) {
      fail(name, line, "more than " + std::to_string(lasers) + " lasers: is the file another sensor's?");
    }
    beams.push_back(parse_line(row, name, line));
  }
  if (beams.size() != lasers) {
    fail(name, line,
         "ends after " + std::to_string(beams.size()) + " of " + std::to_string(lasers) +
             " lasers: is the file whole, and this sensor's?");
  }
  rank_rings(beams);
  return beams;
}

}  // namespace landfix::drivers::robosense
