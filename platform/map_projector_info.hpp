// Autoware's map_projector_info.yaml: how the map's x and y come from latitude and longitude.
#pragma once

#include <filesystem>
#include <string_view>

#include "platform/map_reference.hpp"

namespace landfix::platform {

/// All of the reference but the hash. Throws std::runtime_error: path:line:column, what is wrong, and what is
/// allowed. A map that is Local has no projection.
[[nodiscard]] MapReference read_map_projector_info(const std::filesystem::path& path);
[[nodiscard]] MapReference parse_map_projector_info(std::string_view text, const std::filesystem::path& path);

}  // namespace landfix::platform
