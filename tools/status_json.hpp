// The engine's status as JSON: what /status.json says, and `landfix top` reads.
#pragma once

#include <nlohmann/json.hpp>

#include "platform/engine_status.hpp"

namespace landfix::tools {

[[nodiscard]] nlohmann::ordered_json to_json(const platform::EngineStatus& status);

}  // namespace landfix::tools
