#include "tools/daemon_status.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "platform/configuration.hpp"
#include "tools/command.hpp"
#include "tools/metrics_socket.hpp"

namespace landfix::tools {
namespace {

[[nodiscard]] std::string address_of(const DaemonAddress& daemon) {
  if (!daemon.address.empty()) return daemon.address;
  if (daemon.config.empty()) return "127.0.0.1:9464";
  std::string address = platform::read_configuration(daemon.config).metrics.address;
  if (address.empty()) {
    throw UsageError(fmt::format("{}: [metrics] address is empty: the daemon tells nobody how it is",
                                 daemon.config.string()));
  }
  return address;
}

}  // namespace

void add_daemon_options(CLI::App& command, DaemonAddress& daemon) {
  command.add_option("--config", daemon.config, "the daemon's configuration, for its [metrics] address")
      ->type_name("FILE");
  command
      .add_option("--address", daemon.address,
                  "where it offers metrics, IPV4:PORT or unix:/PATH; else 127.0.0.1:9464")
      ->type_name("ADDRESS");
}

nlohmann::json daemon_status(const DaemonAddress& daemon) {
  const std::string address = address_of(daemon);
  nlohmann::json status =
      nlohmann::json::parse(http_get(address, "/status.json"), nullptr, /*allow_exceptions=*/false);
  if (!status.is_object() || !status.contains("stage_ms")) {
    throw std::runtime_error(fmt::format("{}: what answers there is not landfixd", address));
  }
  return status;
}

}  // namespace landfix::tools
