// A sensor by its name, and the calibration of one unit of it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/beam.hpp"
#include "drivers/sensor_model.hpp"

namespace landfix::tools {

/// Throws UsageError, with the names there are.
[[nodiscard]] const drivers::SensorModel& find_sensor(const std::string& name);

/// The beams of the unit; empty, which means the model's, where `path` is. Throws UsageError where the model
/// takes no calibration, std::runtime_error where the file does not do.
[[nodiscard]] std::vector<drivers::Beam> load_calibration(const drivers::SensorModel& model,
                                                          const std::filesystem::path& path);

}  // namespace landfix::tools
