// A sensor by its name, and the calibration of one unit of it.
#pragma once

#include <filesystem>
#include <string>

#include "drivers/calibration.hpp"
#include "drivers/sensor_model.hpp"

namespace landfix::tools {

/// Throws UsageError, with the names there are.
[[nodiscard]] const drivers::SensorModel& find_sensor(const std::string& name);

/// The unit's file, nothing where `path` is empty. Throws UsageError where the model takes no calibration, or
/// needs one and there is none; std::runtime_error where the file does not do.
[[nodiscard]] drivers::Calibration load_calibration(const drivers::SensorModel& model,
                                                    const std::filesystem::path& path);

}  // namespace landfix::tools
