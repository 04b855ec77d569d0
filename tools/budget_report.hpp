// The budget as text and as JSON.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "platform/budget.hpp"

namespace landfix::tools {

[[nodiscard]] std::string to_text(const platform::Budget& budget);
[[nodiscard]] nlohmann::ordered_json to_json(const platform::Budget& budget);

}  // namespace landfix::tools
