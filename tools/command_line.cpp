#include "tools/command_line.hpp"

#include <cstddef>
#include <string_view>

namespace landfix::tools {
namespace {

/// As a shell takes it for one word.
[[nodiscard]] std::string quoted(const std::string& word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./,:=@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char character : word) {
    if (character == '\'')
      text += "'\\''";
    else
      text += character;
  }
  return text + "'";
}

}  // namespace

std::string command_line(const CLI::App& command) {
  std::string line = "landfix " + command.get_name();
  for (const CLI::Option* const option : command.get_options()) {
    if (option->count() == 0) continue;
    line += " " + option->get_name();
    if (option->get_expected_min() == 0) continue;  // a flag
    for (const std::string& value : option->results()) line += " " + quoted(value);
  }
  return line;
}

}  // namespace landfix::tools
