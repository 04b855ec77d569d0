// What a command was asked to do, in the words that ask for it again.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace landfix::tools {

/// The command with the options that were given, as a shell takes them.
[[nodiscard]] std::string command_line(const CLI::App& command);

}  // namespace landfix::tools
