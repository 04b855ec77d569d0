#include "tools/sensor_setup.hpp"

#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "platform/atomic_file.hpp"
#include "tools/command.hpp"

namespace landfix::tools {

const drivers::SensorModel& find_sensor(const std::string& name) {
  if (const drivers::SensorModel* const model = drivers::find_sensor_model(name)) return *model;
  std::vector<std::string_view> names;
  for (const drivers::SensorModel& model : drivers::sensor_models()) names.push_back(model.name);
  throw UsageError(fmt::format("no sensor '{}'; there are {}", name, fmt::join(names, ", ")));
}

drivers::Calibration load_calibration(const drivers::SensorModel& model, const std::filesystem::path& path) {
  using drivers::CalibrationUse;
  if (path.empty()) {
    if (model.calibration == CalibrationUse::required) {
      throw UsageError(fmt::format(
          "{} needs the file that the unit was delivered with or gives out: --calibration FILE, or [sensor] "
          "calibration in the configuration",
          model.name));
    }
    return {};
  }
  if (model.calibration == CalibrationUse::none) {
    throw UsageError(
        fmt::format("{}: {} takes no calibration, its beams are the model's", path.string(), model.name));
  }
  return drivers::parse_calibration(model, platform::read_file(path), path.string());
}

}  // namespace landfix::tools
