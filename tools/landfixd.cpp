#include <exception>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "platform/configuration.hpp"
#include "tools/command.hpp"
#include "tools/daemon.hpp"
#include "tools/daemon_check.hpp"
#include "tools/journal.hpp"

namespace {

/// One that cannot be used ends with 2, after which systemd does not try again; whatever else is missing,
/// with 1.
void require_usable(const std::string& config) {
  try {
    (void)landfix::platform::read_configuration(config);
  } catch (const std::runtime_error& error) {
    throw landfix::tools::UsageError(error.what());
  }
}

int run(int argc, char** argv) {
  using namespace landfix::tools;
  CLI::App app{
      "The vehicle's daemon: packets of the sensor in, poses on the CAN bus. It stays in the foreground, "
      "says what\n"
      "changes on stderr, and ends within a second of SIGTERM.",
      "landfixd"};
  std::string config;
  bool only_check = false;
  bool json = false;
  app.set_version_flag("--version", std::string("landfixd ") + LANDFIX_VERSION);
  app.add_option("--config", config, "configuration (landfix.toml explains every key)")
      ->type_name("FILE")
      ->required();
  CLI::Option* const check = app.add_flag(
      "--check", only_check,
      "read the configuration, the map and the calibration, print the budget of threads, memory and rates, "
      "and end");
  app.add_flag("--json", json, "with --check: as one JSON object")->needs(check);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "landfixd: {} (see landfixd --help)\n", error.what());
    return 2;
  }
  require_usable(config);
  if (only_check) {
    fmt::print("{}", check_daemon(config, json));
  } else {
    run_daemon(config);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  using landfix::tools::log_line, landfix::tools::Severity;
  try {
    return run(argc, argv);
  } catch (const landfix::tools::UsageError& error) {
    log_line(Severity::error, error.what());
    return 2;
  } catch (const std::exception& error) {
    log_line(Severity::error, error.what());
    return 1;
  }
}
