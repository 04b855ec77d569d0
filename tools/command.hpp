// What the commands of `landfix` share: how one is declared, and how it fails.
#pragma once

#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace landfix::tools {

/// Arguments that parse but cannot be used together or with this input: one line, exit 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Adds a subcommand with its options to `app`; its callback runs the command. Each command is one file.
/// Anything but UsageError that it throws is one line on stderr and exit 1.
using AddCommand = void (*)(CLI::App& app);

/// Runs `landfix` with its arguments; returns the exit code.
[[nodiscard]] int run(int argc, const char* const* argv);

/// Progress, as one line on stderr that the next one overwrites and an empty one erases; nothing where stderr
/// is not a terminal.
void show_progress(std::string_view text);

/// The option --json, the same in every command: one object on stdout and nothing else.
void add_json_option(CLI::App& command, bool& json);

/// For an option that is a number from one bound to another; NaN is outside of all.
template <class Number>
[[nodiscard]] CLI::Validator in_range(Number least, Number most) {
  return {[least, most](std::string& text) {
            Number value{};
            if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most)
              return std::string();
            return fmt::format("'{}' is not a number from {} to {}", text, least, most);
          },
          ""};
}

/// For an option whose value is an enumerator: takes its name; another is an error that lists them.
template <class Enum>
[[nodiscard]] CLI::Validator one_of(const std::map<std::string, Enum>& names) {
  return {[names](std::string& text) {
            if (const auto found = names.find(text); found != names.end()) {
              text = std::to_string(static_cast<std::underlying_type_t<Enum>>(found->second));
              return std::string();
            }
            std::string error = "'" + text + "' is none of";
            for (const auto& [name, value] : names) error += ' ' + name;
            return error;
          },
          ""};
}

}  // namespace landfix::tools
