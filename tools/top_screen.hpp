// The running daemon on one screen.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace landfix::tools {

/// Of two looks at /status.json, rates between them; or of one look twice, rates since the start. Throws
/// nlohmann::json::exception where it is another program's JSON.
[[nodiscard]] std::string top_screen(const nlohmann::json& now, const nlohmann::json& before);

}  // namespace landfix::tools
