#include "drivers/calibration_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace landfix::drivers {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string_view take_until(std::string_view& text, char separator) {
  const auto end = std::min(text.find(separator), text.size());
  const std::string_view taken = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return taken;
}

std::optional<double> to_number(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string_view to_text(std::span<const std::byte> file) {
  std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

void fail(std::string_view name, std::size_t line, const std::string& what) {
  throw std::runtime_error(std::string(name) + ":" + std::to_string(line) + ": " + what);
}

std::size_t to_index(double number, std::size_t first, std::size_t count, std::string_view what,
                     std::string_view name, std::size_t line) {
  const double index = number - static_cast<double>(first);
  if (!(index >= 0.0 && index < static_cast<double>(count)) || index != std::floor(index)) {
    fail(name, line,
         std::string(what) + " is not one of " + std::to_string(first) + " to " +
             std::to_string(first + count - 1) + ": is the file another sensor's?");
  }
  return static_cast<std::size_t>(index);
}

void rank_rings(std::vector<Beam>& beams) {
  for (std::size_t i = 0; i < beams.size(); ++i) {
    beams[i].ring = ring_of(i, beams.size(), [&](std::size_t beam) { return beams[beam].elevation_deg; });
  }
}

}  // namespace landfix::drivers
