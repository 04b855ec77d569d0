// From a row of the catalogue to its decoder.
#pragma once

#include "drivers/any_decoder.hpp"
#include "drivers/calibration.hpp"
#include "drivers/decoder_options.hpp"
#include "drivers/sensor_model.hpp"

namespace landfix::drivers {

/// `calibration`: the unit's own (parse_calibration); nothing for the model's table, or where the packets
/// bring it. Throws std::runtime_error where the options or the calibration cannot be used with the model.
[[nodiscard]] AnyDecoder make_decoder(const SensorModel& model, const DecoderOptions& options,
                                      const Calibration& calibration = {});

}  // namespace landfix::drivers
