// landfixd: the sensor's packets in, poses on the bus, until it is told to stop.
#pragma once

#include <filesystem>

namespace landfix::tools {

/// Runs until SIGTERM or SIGINT. Throws std::runtime_error where it cannot begin.
void run_daemon(const std::filesystem::path& config);

}  // namespace landfix::tools
