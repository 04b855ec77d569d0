// The sections [odometry] and [[odometry.signal]] of the configuration.
#pragma once

#include "platform/odometry.hpp"
#include "platform/toml_section.hpp"

namespace landfix::platform {

/// Signals come from the keys themselves or, by name, from a DBC file. Throws std::runtime_error with the
/// place and what is wrong.
void read_odometry(TomlSection section, OdometrySettings& odometry);

}  // namespace landfix::platform
