#include "drivers/velodyne/hdl64_calibration_file.hpp"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <system_error>

namespace landfix::drivers::velodyne {
namespace {

/// Real files have 50 kB. The parsers of others that read them are not to be tried with more.
constexpr std::size_t kMostBytes = 1 << 20;
constexpr std::string_view kBlank = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

}  // namespace

void fail_at(std::string_view name, std::size_t line, const std::string& what) {
  throw std::runtime_error(std::string(name) + ":" + std::to_string(line) + ": " + what);
}

double parse_number(std::string_view text, std::string_view what, std::string_view name, std::size_t line) {
  std::string_view digits = trimmed(text);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    fail_at(name, line,
            std::string(what) + " is not a number: '" + std::string(text.substr(0, 40)) + "'; correct it");
  }
  return value;
}

std::uint8_t parse_intensity(std::string_view text, std::string_view what, std::string_view name,
                             std::size_t line) {
  const double value = parse_number(text, what, name, line);
  if (value < 0.0 || value > 255.0) fail_at(name, line, std::string(what) + " is not one of 0 to 255");
  return static_cast<std::uint8_t>(value);
}

void place_laser(const Hdl64Laser& laser, std::size_t id, std::string_view name, std::size_t line,
                 Hdl64Calibration& calibration) {
  if (!is_plausible(laser)) {
    fail_at(name, line,
            "laser " + std::to_string(id) +
                " has an angle beyond 90 degrees, a correction beyond 10 m, an offset beyond 2 m or a least "
                "intensity above its greatest: are the units those of this kind of file?");
  }
  calibration.lasers[id] = laser;
  complete_two_point(calibration.lasers[id]);
}

Hdl64Calibration parse_hdl64_calibration(std::span<const std::byte> file, std::string_view name) {
  std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (text.size() > kMostBytes) fail_at(name, 1, "is longer than any calibration: is it another file?");
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::string_view content = trimmed(text);
  if (content.empty()) fail_at(name, 1, "is empty: expected the unit's db.xml or its YAML file");
  return content.starts_with('<') ? parse_hdl64_db_xml(text, name) : parse_hdl64_yaml(text, name);
}

}  // namespace landfix::drivers::velodyne
