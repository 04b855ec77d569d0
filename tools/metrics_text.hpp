// The engine's status as Prometheus reads it: text format 0.0.4.
#pragma once

#include <string>

#include "platform/engine_status.hpp"

namespace landfix::tools {

[[nodiscard]] std::string to_prometheus(const platform::EngineStatus& status);

}  // namespace landfix::tools
