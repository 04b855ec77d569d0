// landfix doctor: whether this host is fit for real time. Reads only.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "platform/configuration.hpp"
#include "platform/packet_rate.hpp"
#include "tools/command.hpp"
#include "tools/host_checks.hpp"
#include "tools/host_rights.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/sensor_setup.hpp"

namespace landfix::tools {
namespace {

struct DoctorOptions {
  std::filesystem::path config;
  std::string interface;
  std::filesystem::path root = "/";
  bool json = false;
};

HostNeeds needs_of(const DoctorOptions& options, const platform::Configuration& configuration) {
  HostNeeds needs{.receive_bytes = std::size_t{4} << 20, .sensor_interface = options.interface};
  if (options.config.empty()) return needs;
  needs.receive_bytes = platform::receive_buffer_bytes(find_sensor(configuration.sensor.model));
  needs.can_interface = configuration.can.interface;
  const platform::RealtimeSettings& realtime = configuration.realtime;
  for (const int core : {realtime.rx.core, realtime.solve.core, realtime.tx.core}) {
    if (core >= 0) needs.cores.push_back(core);
  }
  std::sort(needs.cores.begin(), needs.cores.end());
  needs.cores.erase(std::unique(needs.cores.begin(), needs.cores.end()), needs.cores.end());
  return needs;
}

std::vector<HostCheck> check_all(const DoctorOptions& options) {
  platform::Configuration configuration;
  if (!options.config.empty()) configuration = platform::read_configuration(options.config);
  std::vector<HostCheck> checks = check_host(options.root, needs_of(options, configuration));
  if (!options.config.empty()) checks.push_back(check_discipline(configuration.can.interface));
  checks.push_back(check_clock());
  for (HostCheck& check : check_rights(configuration.realtime)) checks.push_back(std::move(check));
  return checks;
}

void print_table(const std::vector<HostCheck>& checks) {
  for (const HostCheck& check : checks) {
    fmt::print("{:<4} {:<28} {}\n", to_string(check.verdict), check.name, check.found);
    if (!check.mend.empty()) fmt::print("{:<4} {:<28} -> {}\n", "", "", check.mend);
  }
}

void print_json(const std::vector<HostCheck>& checks) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const HostCheck& check : checks) {
    rows.push_back({{"name", check.name},
                    {"verdict", to_string(check.verdict)},
                    {"found", check.found},
                    {"mend", check.mend}});
  }
  fmt::print("{}\n", nlohmann::ordered_json{{"checks", rows}}.dump(2, ' ', false,
                                                                   nlohmann::json::error_handler_t::replace));
}

}  // namespace

void add_doctor_command(CLI::App& app) {
  const auto options = std::make_shared<DoctorOptions>();
  CLI::App& command = *app.add_subcommand("doctor", "whether this host is fit for real time, and the mends");
  command.add_option("--config", options->config, "the configuration that says what is needed");
  command.add_option("--interface", options->interface, "the Ethernet interface to the sensor, such as eth0");
  command.add_option("--root", options->root, "look below this folder instead of /")->group("");
  add_json_option(command, options->json);
  command.footer(
      "WARN: what to change stands below it; ?: the host does not say. Rights are tried for real, as the "
      "user who "
      "runs this: run it as root for those of the service.");
  command.callback([options] {
    const std::vector<HostCheck> checks = check_all(*options);
    options->json ? print_json(checks) : print_table(checks);
  });
}

}  // namespace landfix::tools
