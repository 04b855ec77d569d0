// landfix sensors: the catalogue.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "drivers/sensor_model.hpp"
#include "platform/pcd_writer.hpp"
#include "tools/command.hpp"
#include "tools/landfix_commands.hpp"

namespace landfix::tools {
namespace {

using drivers::SensorModel;

/// What one point of any decoder holds.
std::vector<std::string> field_names() {
  std::vector<std::string> names;
  names.reserve(platform::kPointMembers.size());
  for (const platform::PcdMember& member : platform::kPointMembers) names.emplace_back(member.name);
  return names;
}

std::vector<int> rotation_rates(const SensorModel& model) {
  std::vector<int> rates_hz(model.rotation_hz.begin(), model.rotation_hz.end());
  std::erase(rates_hz, 0);
  return rates_hz;
}

std::vector<int> payload_sizes(const SensorModel& model) {
  return {model.payload_sizes.begin(), model.payload_sizes.end()};
}

nlohmann::json to_json(const SensorModel& model) {
  return {{"name", model.name},
          {"vendor", model.vendor},
          {"display_name", model.display_name},
          {"beams", model.beam_count},
          {"rotation_hz", rotation_rates(model)},
          {"range_m", {model.min_range_m, model.max_range_m}},
          {"range_precision_m", model.range_precision_m},
          {"vertical_field_deg", {model.vertical_down_deg, model.vertical_up_deg}},
          {"vertical_resolution_deg", model.vertical_resolution_deg},
          {"horizontal_resolution_at_10_hz_deg", model.horizontal_resolution_at_10_hz_deg},
          {"wavelength_nm", model.wavelength_nm},
          {"diameter_mm", model.diameter_mm},
          {"height_mm", model.height_mm},
          {"weight_kg", model.weight_kg},
          {"returns", model.max_returns},
          {"data_port", model.data_port},
          {"telemetry_port", model.telemetry_port},
          {"payload_bytes", payload_sizes(model)},
          {"calibration", to_string(model.calibration)},
          {"fields", field_names()}};
}

void print_json() {
  nlohmann::json sensors = nlohmann::json::array();
  for (const SensorModel& model : drivers::sensor_models()) sensors.push_back(to_json(model));
  fmt::print("{}\n", nlohmann::json{{"sensors", sensors}}.dump(2));
}

void print_table() {
  constexpr const char* kRow =
      "{:<11} {:<9} {:<25} {:>5}  {:<10}  {:<11} {:>9}  {:<16} {:>6} {:>10}  {:>5}  {:<13} {:>6}  {}\n";
  fmt::print(kRow, "NAME", "VENDOR", "MODEL", "BEAMS", "RATE", "RANGE", "PRECISION", "VERTICAL", "STEP",
             "HORIZONTAL", "LASER", "SIZE", "WEIGHT", "CALIBRATION");
  fmt::print(kRow, "", "", "", "", "Hz", "m", "m", "deg", "deg", "deg@10Hz", "nm", "mm", "kg", "");
  for (const SensorModel& model : drivers::sensor_models()) {
    fmt::print(kRow, model.name, model.vendor, model.display_name, model.beam_count,
               fmt::format("{}", fmt::join(rotation_rates(model), " ")),
               fmt::format("{:g} to {:g}", model.min_range_m, model.max_range_m), model.range_precision_m,
               fmt::format("{:+g} to {:+g}", model.vertical_down_deg, model.vertical_up_deg),
               model.vertical_resolution_deg, model.horizontal_resolution_at_10_hz_deg, model.wavelength_nm,
               fmt::format("{:g} x {:g}", model.diameter_mm, model.height_mm), model.weight_kg,
               to_string(model.calibration));
  }
  fmt::print(
      "\nVERTICAL and STEP: field of view and finest spacing of the beams. SIZE: diameter x height.\n"
      "CALIBRATION, the unit's own file: none is taken; optional, better than the model's table; in_stream, "
      "the\n"
      "packets bring it and a file is the alternative; required, there are no points without it.\n"
      "Every point has the fields {}; both returns of a firing are kept.\n",
      fmt::join(field_names(), " "));
}

}  // namespace

void add_sensors_command(CLI::App& app) {
  const auto json = std::make_shared<bool>(false);
  CLI::App& command = *app.add_subcommand("sensors", "the catalogue of sensors");
  add_json_option(command, *json);
  command.callback([json] { *json ? print_json() : print_table(); });
}

}  // namespace landfix::tools
