// How a CAN interface is, for people: what is wrong and what to do.
#pragma once

#include <string>
#include <string_view>

#include "platform/bus_status.hpp"

namespace landfix::platform {

/// One line without its end. `error`: errno that made the state so; 0: none.
[[nodiscard]] std::string describe_bus(std::string_view interface, BusState state, int error);

}  // namespace landfix::platform
