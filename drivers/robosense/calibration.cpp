#include "drivers/robosense/calibration.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>

namespace landfix::drivers::robosense {
namespace {

constexpr double kMaxAngleDeg = 90.0;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// Nothing where it is not a finite number and nothing else.
std::optional<double> number(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

[[noreturn]] void fail(std::string_view name, std::size_t line, const std::string& what) {
  throw std::runtime_error(std::string(name) + ":" + std::to_string(line) + ": " + what);
}

Beam parse_line(std::string_view text, std::string_view name, std::size_t line) {
  const auto comma = std::min(text.find(','), text.size());
  const auto vertical_deg = number(text.substr(0, comma));
  const auto horizontal_deg = number(text.substr(std::min(comma + 1, text.size())));
  if (!vertical_deg || !horizontal_deg) {
    fail(name, line, "not two numbers: expected vertical,horizontal in degrees, a line a laser");
  }
  if (std::abs(*vertical_deg) > kMaxAngleDeg || std::abs(*horizontal_deg) > kMaxAngleDeg) {
    fail(name, line, "angle is beyond 90 degrees: expected vertical,horizontal in degrees");
  }
  return {.elevation_deg = *vertical_deg, .azimuth_offset_deg = *horizontal_deg};
}

void rank_rings(std::vector<Beam>& beams) {
  std::vector<std::size_t> order(beams.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return beams[a].elevation_deg < beams[b].elevation_deg;
  });
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    beams[order[rank]].ring = static_cast<std::uint16_t>(rank);
  }
}

}  // namespace

std::vector<Beam> parse_calibration(std::span<const std::byte> file, std::string_view name,
                                    std::size_t lasers) {
  std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<Beam> beams;
  std::size_t line = 0;
  while (!text.empty()) {
    ++line;
    const auto end = std::min(text.find('\n'), text.size());
    const std::string_view row = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
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
