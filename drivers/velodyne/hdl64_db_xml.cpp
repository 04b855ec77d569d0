// Velodyne's db.xml, an archive of Boost's serialisation: arrays over the lasers, and <points_> with an item
// a laser (HDL-64E S2 and S2.1 User's Manual, "db.xml Calibration Parameters").
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <pugixml.hpp>

#include "drivers/calibration_text.hpp"
#include "drivers/velodyne/hdl64_calibration_file.hpp"

namespace landfix::drivers::velodyne {
namespace {

constexpr double kMetres_per_cm = 0.01;
constexpr double kRangeUnit_cm = 0.2;

class DbXml {
 public:
  DbXml(std::string_view text, std::string_view name) : name_(name) {
    for (std::size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1)) {
      ends_of_lines_.push_back(static_cast<std::ptrdiff_t>(at));
    }
    const pugi::xml_parse_result result = document_.load_buffer(text.data(), text.size());
    if (!result) {
      fail(name, line_at(result.offset),
           std::string("not XML: ") + result.description() + "; take the file as it was delivered");
    }
    root_ = document_.child("boost_serialization").child("DB");
    if (!root_) fail(name, 1, "no <boost_serialization><DB>: is it the unit's db.xml?");
  }

  [[nodiscard]] Hdl64Calibration read() const {
    check_range_unit();
    Hdl64Calibration calibration;
    std::array<bool, kHdl64Lasers> seen{};
    const pugi::xml_node points = root_.child("points_");
    if (!points) fail(name_, line_of(root_), "no <points_>: is it the unit's db.xml?");
    for (const pugi::xml_node item : points.children("item")) {
      const pugi::xml_node laser = item.child("px");
      if (!laser) fail(name_, line_of(item), "an <item> of <points_> without <px>");
      const std::size_t id =
          to_index(required(laser, "id_"), 0, kHdl64Lasers, "<id_>", name_, line_of(laser));
      if (seen[id]) fail(name_, line_of(laser), "laser " + std::to_string(id) + " is given twice");
      seen[id] = true;
      place_laser(read_laser(laser), id, name_, line_of(laser), calibration);
    }
    read_arrays(calibration);
    for (std::size_t id = 0; id < kHdl64Lasers; ++id) {
      if (seen[id]) continue;
      if (calibration.lasers[id].enabled) {
        fail(name_, line_of(points), "laser " + std::to_string(id) + " of 64 is missing from <points_>");
      }
    }
    return calibration;
  }

 private:
  [[nodiscard]] std::size_t line_at(std::ptrdiff_t offset) const {
    const auto end = std::ranges::lower_bound(ends_of_lines_, offset);
    return static_cast<std::size_t>(end - ends_of_lines_.begin()) + 1;
  }
  [[nodiscard]] std::size_t line_of(const pugi::xml_node& node) const { return line_at(node.offset_debug()); }

  [[nodiscard]] double number(const pugi::xml_node& node) const {
    return parse_number(node.child_value(), node.name(), name_, line_of(node));
  }
  [[nodiscard]] double required(const pugi::xml_node& laser, const char* key) const {
    const pugi::xml_node node = laser.child(key);
    if (!node) fail(name_, line_of(laser), std::string("a laser without <") + key + ">");
    return number(node);
  }
  [[nodiscard]] double optional(const pugi::xml_node& laser, const char* key) const {
    const pugi::xml_node node = laser.child(key);
    return node.empty() ? 0.0 : number(node);
  }

  void check_range_unit() const {
    const pugi::xml_node unit = root_.child("distLSB_");
    if (!unit || std::abs(number(unit) - kRangeUnit_cm) < 1e-6) return;
    fail(name_, line_of(unit), "<distLSB_> is not 0.2: the file is another sensor's");
  }

  [[nodiscard]] Hdl64Laser read_laser(const pugi::xml_node& laser) const {
    return {.rotation_deg = required(laser, "rotCorrection_"),
            .elevation_deg = required(laser, "vertCorrection_"),
            .range_m = kMetres_per_cm * required(laser, "distCorrection_"),
            .range_x_m = kMetres_per_cm * optional(laser, "distCorrectionX_"),
            .range_y_m = kMetres_per_cm * optional(laser, "distCorrectionY_"),
            .vertical_offset_m = kMetres_per_cm * optional(laser, "vertOffsetCorrection_"),
            .horizontal_offset_m = kMetres_per_cm * optional(laser, "horizOffsetCorrection_"),
            .focal_distance_m = kMetres_per_cm * optional(laser, "focalDistance_"),
            .focal_slope = optional(laser, "focalSlope_")};
  }

  /// The arrays beside <points_>, where there are such.
  void read_arrays(Hdl64Calibration& calibration) const {
    for_each(
        "enabled_", [](Hdl64Laser& laser, std::uint8_t value) { laser.enabled = value != 0; }, calibration);
    for_each(
        "minIntensity_", [](Hdl64Laser& laser, std::uint8_t value) { laser.min_intensity = value; },
        calibration);
    for_each(
        "maxIntensity_", [](Hdl64Laser& laser, std::uint8_t value) { laser.max_intensity = value; },
        calibration);
    for (std::size_t id = 0; id < kHdl64Lasers; ++id) {
      const Hdl64Laser& laser = calibration.lasers[id];
      if (laser.min_intensity <= laser.max_intensity) continue;
      fail(name_, line_of(root_.child("minIntensity_")),
           "laser " + std::to_string(id) + " has a least intensity above its greatest");
    }
  }

  template <class Set>
  void for_each(const char* array, Set set, Hdl64Calibration& calibration) const {
    std::size_t id = 0;
    for (const pugi::xml_node item : root_.child(array).children("item")) {
      if (id == kHdl64Lasers) {
        fail(name_, line_of(item), std::string("<") + array + "> has more than 64 items");
      }
      set(calibration.lasers[id++], parse_intensity(item.child_value(), array, name_, line_of(item)));
    }
  }

  std::vector<std::ptrdiff_t> ends_of_lines_;
  std::string_view name_;
  pugi::xml_document document_;
  pugi::xml_node root_;
};

}  // namespace

Hdl64Calibration parse_hdl64_db_xml(std::string_view text, std::string_view name) {
  return DbXml(text, name).read();
}

}  // namespace landfix::drivers::velodyne
