// What a GPS receiver sends to a sensor once a second.
#pragma once

#include <string>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator {

/// The recommended minimum sentence, GPRMC, with its checksum and CR LF.
[[nodiscard]] std::string nmea_sentence(const GpsFix& fix);

}  // namespace landfix::tools::simulator
