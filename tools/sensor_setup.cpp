#include "tools/sensor_setup.hpp"

#include <fmt/format.h>

#include "drivers/hesai/calibration.hpp"
#include "platform/atomic_file.hpp"
#include "tools/command.hpp"

namespace landfix::tools {

const drivers::SensorModel& find_sensor(const std::string& name) {
  if (const drivers::SensorModel* const model = drivers::find_sensor_model(name)) return *model;
  std::string names;
  for (const drivers::SensorModel& model : drivers::sensor_models()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", model.name);
  }
  throw UsageError(fmt::format("no sensor '{}'; there are {}", name, names));
}

std::vector<drivers::Beam> load_calibration(const drivers::SensorModel& model,
                                            const std::filesystem::path& path) {
  if (path.empty()) return {};
  if (model.format != drivers::PacketFormat::hesai_pandar64) {
    throw UsageError(
        fmt::format("{}: {} takes no calibration, its beams are the model's", path.string(), model.name));
  }
  return drivers::hesai::parse_calibration(platform::read_file(path), path.string(), model.beams);
}

}  // namespace landfix::tools
