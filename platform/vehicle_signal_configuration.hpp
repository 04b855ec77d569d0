// The tables [[odometry.signal]] and [[gnss.signal]] of the configuration.
#pragma once

#include <span>
#include <string_view>

#include "platform/toml_section.hpp"
#include "platform/vehicle_signal.hpp"

namespace landfix::platform {

/// The keys `dbc` and `signal` of a section of that name, with which it ends. Signals come from the keys
/// themselves or, by name, from the DBC file. Throws std::runtime_error with the place and what is wrong.
void read_vehicle_signals(TomlSection& section, std::string_view name, std::span<const VehicleRole> roles,
                          VehicleSignals& signals);

}  // namespace landfix::platform
