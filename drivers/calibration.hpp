// What one unit of a sensor says of itself: read from a file here, or by a decoder from the sensor's own
// packets.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "drivers/beam.hpp"
#include "drivers/ouster/metadata.hpp"
#include "drivers/sensor_model.hpp"
#include "drivers/velodyne/hdl64_calibration.hpp"

namespace landfix::drivers {

/// Nothing: the model's own table, or what the packets bring. Which alternative a format reads is
/// parse_calibration's affair.
using Calibration =
    std::variant<std::monostate, std::vector<Beam>, velodyne::Hdl64Calibration, ouster::Metadata>;

/// Reads the unit's file in the vendor's own format. `name` is for messages. Throws std::runtime_error with
/// the line, what is wrong and what to do; also where the model takes no calibration.
[[nodiscard]] Calibration parse_calibration(const SensorModel& model, std::span<const std::byte> file,
                                            std::string_view name);

}  // namespace landfix::drivers
