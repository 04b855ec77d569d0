// landfix top: the running daemon at a glance.
#include <chrono>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tools/command.hpp"
#include "tools/daemon_status.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/top_screen.hpp"

namespace landfix::tools {
namespace {

struct TopArguments {
  DaemonAddress daemon;
  bool once = false;
  bool json = false;
};

/// Over what stands there, line by line: clearing it all would flicker.
void redraw(const std::string& screen) {
  std::string text = "\x1b[H";
  for (const char character : screen) {
    if (character == '\n') text += "\x1b[K";
    text += character;
  }
  fmt::print("{}\x1b[J", text);
  if (std::fflush(stdout) != 0) throw std::runtime_error("standard output is gone");
}

/// Until it is interrupted, or the daemon is gone.
[[noreturn]] void watch(const DaemonAddress& daemon) {
  constexpr std::chrono::milliseconds kInterval(500);
  nlohmann::json before = daemon_status(daemon);
  while (true) {
    std::this_thread::sleep_for(kInterval);
    nlohmann::json now = daemon_status(daemon);
    redraw(top_screen(now, before));
    before = std::move(now);
  }
}

void top(const TopArguments& arguments) {
  const bool is_terminal = ::isatty(STDOUT_FILENO) == 1;
  if (is_terminal && !arguments.once && !arguments.json) watch(arguments.daemon);
  const nlohmann::json now = daemon_status(arguments.daemon);
  fmt::print("{}", arguments.json ? now.dump(2) + "\n" : top_screen(now, now));
}

}  // namespace

void add_top_command(CLI::App& app) {
  const auto arguments = std::make_shared<TopArguments>();
  CLI::App& command = *app.add_subcommand("top", "the running daemon at a glance");
  add_daemon_options(command, arguments->daemon);
  command.add_flag("--once", arguments->once,
                   "print it once, rates since the start; so it does where stdout is no terminal");
  add_json_option(command, arguments->json);
  command.callback([arguments] { top(*arguments); });
}

}  // namespace landfix::tools
