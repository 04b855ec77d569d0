// From a row of the catalogue to its decoder.
#pragma once

#include <span>

#include "drivers/any_decoder.hpp"
#include "drivers/beam.hpp"
#include "drivers/decoder_options.hpp"
#include "drivers/sensor_model.hpp"

namespace landfix::drivers {

/// `calibration`: the unit's own beams (hesai::parse_calibration), empty for the model's table.
/// Throws std::runtime_error where the options or the calibration cannot be used with the model.
[[nodiscard]] AnyDecoder make_decoder(const SensorModel& model, const DecoderOptions& options,
                                      std::span<const Beam> calibration = {});

}  // namespace landfix::drivers
