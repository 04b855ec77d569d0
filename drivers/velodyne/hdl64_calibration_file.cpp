#include "drivers/velodyne/hdl64_calibration_file.hpp"

#include "drivers/calibration_text.hpp"

namespace landfix::drivers::velodyne {
namespace {

/// Real files have 50 kB. The parsers of others that read them are not to be tried with more.
constexpr std::size_t kMostBytes = 1 << 20;

}  // namespace

double parse_number(std::string_view text, std::string_view what, std::string_view name, std::size_t line) {
  const auto value = to_number(text);
  if (!value) {
    fail(name, line,
         std::string(what) + " is not a number: '" + std::string(text.substr(0, 40)) + "'; correct it");
  }
  return *value;
}

std::uint8_t parse_intensity(std::string_view text, std::string_view what, std::string_view name,
                             std::size_t line) {
  const double value = parse_number(text, what, name, line);
  if (value < 0.0 || value > 255.0) fail(name, line, std::string(what) + " is not one of 0 to 255");
  return static_cast<std::uint8_t>(value);
}

void place_laser(const Hdl64Laser& laser, std::size_t id, std::string_view name, std::size_t line,
                 Hdl64Calibration& calibration) {
  if (!is_plausible(laser)) {
    fail(name, line,
         "laser " + std::to_string(id) +
             " has an angle beyond 90 degrees, a correction beyond 10 m, an offset beyond 2 m or a least "
             "intensity above its greatest: are the units those of this kind of file?");
  }
  calibration.lasers[id] = laser;
  complete_two_point(calibration.lasers[id]);
}

Hdl64Calibration parse_hdl64_calibration(std::span<const std::byte> file, std::string_view name) {
  if (file.size() > kMostBytes) fail(name, 1, "is longer than any calibration: is it another file?");
  const std::string_view text = to_text(file);
  const std::string_view content = trimmed(text);
  if (content.empty()) fail(name, 1, "is empty: expected the unit's db.xml or its YAML file");
  return content.starts_with('<') ? parse_hdl64_db_xml(text, name) : parse_hdl64_yaml(text, name);
}

}  // namespace landfix::drivers::velodyne
