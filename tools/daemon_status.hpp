// The running daemon asked for its status, by the commands that show it.
#pragma once

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace landfix::tools {

/// Where the daemon offers its metrics.
struct DaemonAddress {
  std::filesystem::path config;  ///< [metrics] address; empty: not asked
  std::string address;           ///< in its place
};

/// --config and --address.
void add_daemon_options(CLI::App& command, DaemonAddress& daemon);

/// 127.0.0.1:9464 where neither is given. Throws UsageError where the configuration has no address,
/// std::runtime_error where nothing answers, or something else than landfixd does.
[[nodiscard]] nlohmann::json daemon_status(const DaemonAddress& daemon);

}  // namespace landfix::tools
