// The YAML that ROS drivers make of a db.xml: a map with a list `lasers`, an entry a laser.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <yaml-cpp/yaml.h>

#include "drivers/calibration_text.hpp"
#include "drivers/velodyne/hdl64_calibration_file.hpp"

namespace landfix::drivers::velodyne {
namespace {

constexpr double kDeg_per_rad = 180.0 / std::numbers::pi;
constexpr double kRangeUnit_m = 0.002;
/// Real files nest three deep.
constexpr std::ptrdiff_t kMostBrackets = 500;

std::size_t line_of(const YAML::Mark& mark) {
  return mark.line < 0 ? 1 : static_cast<std::size_t>(mark.line) + 1;
}

class LasersYaml {
 public:
  LasersYaml(const YAML::Node& root, std::string_view name) : root_(root), name_(name) {}

  [[nodiscard]] Hdl64Calibration read() const {
    if (!root_.IsMap()) fail(root_, "no keys: expected `lasers`, with an entry a laser");
    check_range_unit();
    const YAML::Node lasers = root_["lasers"];
    if (!lasers || !lasers.IsSequence()) fail(root_, "no list `lasers`: is it the unit's file?");
    Hdl64Calibration calibration;
    std::array<bool, kHdl64Lasers> seen{};
    for (const YAML::Node& entry : lasers) {
      if (!entry.IsMap()) fail(entry, "an entry of `lasers` is not a laser's keys");
      const std::size_t id =
          to_index(required(entry, "laser_id"), 0, kHdl64Lasers, "laser_id", name_, line_of(entry.Mark()));
      if (seen[id]) fail(entry, "laser " + std::to_string(id) + " is given twice");
      seen[id] = true;
      place_laser(read_laser(entry), id, name_, line_of(entry.Mark()), calibration);
    }
    switch_off_missing(lasers, seen, calibration);
    return calibration;
  }

 private:
  [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
    drivers::fail(name_, line_of(node.Mark()), what);
  }

  [[nodiscard]] std::string scalar(const YAML::Node& node, const char* key) const {
    if (!node.IsScalar()) fail(node, std::string(key) + " is not one value");
    return node.Scalar();
  }
  [[nodiscard]] double number(const YAML::Node& node, const char* key) const {
    return parse_number(scalar(node, key), key, name_, line_of(node.Mark()));
  }
  [[nodiscard]] double required(const YAML::Node& laser, const char* key) const {
    const YAML::Node node = laser[key];
    if (!node) fail(laser, std::string("a laser without ") + key);
    return number(node, key);
  }
  [[nodiscard]] double optional(const YAML::Node& laser, const char* key) const {
    const YAML::Node node = laser[key];
    return node ? number(node, key) : 0.0;
  }
  [[nodiscard]] std::uint8_t intensity(const YAML::Node& laser, const char* key,
                                       std::uint8_t fallback) const {
    const YAML::Node node = laser[key];
    return node ? parse_intensity(scalar(node, key), key, name_, line_of(node.Mark())) : fallback;
  }

  void check_range_unit() const {
    const YAML::Node unit = root_["distance_resolution"];
    if (!unit || std::abs(number(unit, "distance_resolution") - kRangeUnit_m) < 1e-6) return;
    fail(unit, "distance_resolution is not 0.002: the file is another sensor's");
  }

  [[nodiscard]] Hdl64Laser read_laser(const YAML::Node& entry) const {
    Hdl64Laser laser{.rotation_deg = kDeg_per_rad * required(entry, "rot_correction"),
                     .elevation_deg = kDeg_per_rad * required(entry, "vert_correction"),
                     .range_m = required(entry, "dist_correction"),
                     .range_x_m = optional(entry, "dist_correction_x"),
                     .range_y_m = optional(entry, "dist_correction_y"),
                     .vertical_offset_m = optional(entry, "vert_offset_correction"),
                     .horizontal_offset_m = optional(entry, "horiz_offset_correction"),
                     .focal_distance_m = optional(entry, "focal_distance"),
                     .focal_slope = optional(entry, "focal_slope"),
                     .min_intensity = intensity(entry, "min_intensity", 0),
                     .max_intensity = intensity(entry, "max_intensity", 255)};
    // Where the flag is missing, the values were all the same measured: files made before 2022 lack it.
    const YAML::Node flag = entry["two_pt_correction_available"];
    if (flag && !flag.as<bool>()) laser.range_x_m = laser.range_y_m = 0.0;
    return laser;
  }

  void switch_off_missing(const YAML::Node& lasers, const std::array<bool, kHdl64Lasers>& seen,
                          Hdl64Calibration& calibration) const {
    const YAML::Node count = root_["num_lasers"];
    const auto entries = static_cast<double>(lasers.size());
    if (count && number(count, "num_lasers") != entries) {
      fail(count, "num_lasers does not count the entries of `lasers`: is the file whole?");
    }
    const auto* const missing = std::ranges::find(seen, false);
    if (missing == seen.end()) return;
    if (!count || std::ranges::none_of(seen, [](bool is) { return is; })) {
      fail(lasers, "laser " + std::to_string(missing - seen.begin()) +
                       " of 64 is missing, and no num_lasers says that some are switched off");
    }
    for (std::size_t id = 0; id < kHdl64Lasers; ++id) calibration.lasers[id].enabled = seen[id];
  }

  const YAML::Node& root_;
  std::string_view name_;
};

}  // namespace

Hdl64Calibration parse_hdl64_yaml(std::string_view text, std::string_view name) {
  const auto is_bracket = [](char c) { return c == '[' || c == '{'; };
  if (std::ranges::count_if(text, is_bracket) > kMostBrackets) {
    fail(name, 1, "more lists and maps than any calibration has: is it another file?");
  }
  try {
    const YAML::Node root = YAML::Load(std::string(text));
    return LasersYaml(root, name).read();
  } catch (const YAML::Exception& error) {
    fail(name, line_of(error.mark), "not YAML as expected: " + error.msg);
  }
}

}  // namespace landfix::drivers::velodyne
