// landfixd --check: is this configuration fit to drive with, and what will it take?
#pragma once

#include <filesystem>
#include <string>

namespace landfix::tools {

/// Reads all that the daemon would read; the budget as text or as JSON. Throws as the daemon would.
[[nodiscard]] std::string check_daemon(const std::filesystem::path& config, bool json);

}  // namespace landfix::tools
