#include "drivers/hesai/calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "drivers/calibration_text.hpp"

namespace landfix::drivers::hesai {
namespace {

/// Units differ from their model by tenths of a degree; files of other models with as many channels by tens.
constexpr double kMostApartDeg = 5.0;

struct Channel {
  double number = 0.0;
  double elevation_deg = 0.0;
  double azimuth_offset_deg = 0.0;
};

/// Nothing where the line is not three numbers: a header, a hash, blank.
std::optional<Channel> parse_line(std::string_view line) {
  std::array<double, 3> values{};
  for (double& value : values) {
    const auto parsed = to_number(take_until(line, ','));
    if (!parsed) return std::nullopt;
    value = *parsed;
  }
  if (!trimmed(line).empty()) return std::nullopt;
  return Channel{values[0], values[1], values[2]};
}

/// Puts a channel into its place, if it is one and has not been seen.
void place(const Channel& channel, std::string_view name, std::size_t line, std::vector<Beam>& beams,
           std::vector<bool>& seen) {
  const std::size_t index = to_index(channel.number, 1, beams.size(), "channel", name, line);
  if (seen[index]) fail(name, line, "channel " + std::to_string(index + 1) + " is given twice");
  Beam& beam = beams[index];
  if (std::abs(channel.elevation_deg - beam.elevation_deg) > kMostApartDeg ||
      std::abs(channel.azimuth_offset_deg - beam.azimuth_offset_deg) > kMostApartDeg) {
    fail(name, line,
         "channel " + std::to_string(index + 1) +
             " points more than 5 degrees away from where the model's does: is the file another "
             "sensor's, or are its columns not channel,elevation,azimuth?");
  }
  seen[index] = true;
  beam.elevation_deg = channel.elevation_deg;
  beam.azimuth_offset_deg = channel.azimuth_offset_deg;
}

}  // namespace

std::vector<Beam> parse_calibration(std::span<const std::byte> file, std::string_view name,
                                    std::span<const Beam> table) {
  std::string_view text = to_text(file);
  std::vector<Beam> beams(table.begin(), table.end());
  std::vector<bool> seen(beams.size(), false);
  std::size_t line = 0;
  while (!text.empty()) {
    ++line;
    if (const auto channel = parse_line(take_until(text, '\n'))) place(*channel, name, line, beams, seen);
  }
  const auto missing = std::find(seen.begin(), seen.end(), false);
  if (missing != seen.end()) {
    fail(name, line,
         "channel " + std::to_string(missing - seen.begin() + 1) + " of " + std::to_string(beams.size()) +
             " is missing, expected a line channel,elevation,azimuth: read the angle correction from the "
             "sensor again");
  }
  rank_rings(beams);
  return beams;
}

}  // namespace landfix::drivers::hesai
