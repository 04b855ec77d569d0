// The metadata file of one unit: JSON, as the sensor gives it out (GET /api/v1/sensor/metadata, TCP port 7501
// before that) or as the vendor's tools save it beside a recording.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "drivers/ouster/metadata.hpp"
#include "drivers/sensor_model.hpp"

namespace landfix::drivers::ouster {

/// Reads the flat layout of firmware 1.12 to 2.x, the nested one of later firmware, and files reduced to
/// beam angles and `lidar_mode`; what else is missing gets the vendor's defaults. Throws std::runtime_error
/// with `name`, the line of the key, what is wrong and what to do, also where the file is another model's.
[[nodiscard]] Metadata parse_metadata(const SensorModel& model, std::span<const std::byte> file,
                                      std::string_view name);

}  // namespace landfix::drivers::ouster
