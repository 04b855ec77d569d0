#include "tools/command.hpp"

#include <cerrno>
#include <cstdio>
#include <exception>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "tools/landfix_commands.hpp"

namespace landfix::tools {
namespace {

constexpr int kUnusableArguments = 2;
constexpr int kAnythingElse = 1;

}  // namespace

void show_progress(std::string_view text) {
  static const bool stderr_is_terminal = ::isatty(STDERR_FILENO) == 1;
  if (stderr_is_terminal) fmt::print(stderr, "\r{}\x1b[K", text);
}

void add_json_option(CLI::App& command, bool& json) {
  command.add_flag("--json", json, "print one JSON object on stdout and nothing else");
}

int run(int argc, const char* const* argv) {
  CLI::App app("landfix tells a vehicle where it is, from LiDAR alone.", "landfix");
  app.set_version_flag("--version", std::string("landfix ") + LANDFIX_VERSION);
  app.require_subcommand(1);
  app.footer("landfix COMMAND --help explains a command.");
  for (const AddCommand add : kCommands) add(app);
  try {
    app.parse(argc, argv);
    if (std::fflush(stdout) != 0) throw std::system_error(errno, std::generic_category(), "standard output");
    return 0;
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "landfix: {} (see landfix --help)\n", error.what());
    return kUnusableArguments;
  } catch (const UsageError& error) {
    fmt::print(stderr, "landfix: {}\n", error.what());
    return kUnusableArguments;
  } catch (const std::exception& error) {
    fmt::print(stderr, "landfix: {}\n", error.what());
    return kAnythingElse;
  }
}

}  // namespace landfix::tools
