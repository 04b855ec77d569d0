// What the vehicle's own bus would say of the drive: speed, yaw rate and a satellite receiver's position, as
// wrong as those of real vehicles.
#pragma once

#include <filesystem>
#include <string>

#include "tools/simulator/drive.hpp"

namespace landfix::tools::simulator {

/// As `candump -l` would have logged it: the speed at 100 Hz in steps of 0.01 km/h, 0.5 % too high, the yaw
/// rate at 50 Hz in steps of 0.01 deg/s, 0.05 deg/s too high, both with noise; a GnssReceiver at 5 Hz.
void write_odometry_log(const Drive& drive, const std::filesystem::path& path);

/// The section of the configuration that reads it.
[[nodiscard]] std::string odometry_section();

}  // namespace landfix::tools::simulator
