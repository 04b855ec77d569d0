#include "tools/journal.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace landfix::tools {

void log_line(Severity severity, std::string_view text) {
  static const bool is_terminal = ::isatty(STDERR_FILENO) == 1;
  if (is_terminal) {
    fmt::print(stderr, "landfixd: {}\n", text);
  } else {
    fmt::print(stderr, "<{}>{}\n", static_cast<int>(severity), text);
  }
}

}  // namespace landfix::tools
