// What a service says, a line each on stderr, with the severity in front as journald reads it (sd-daemon(3));
// a terminal is spared that.
#pragma once

#include <string_view>

namespace landfix::tools {

enum class Severity : int { error = 3, warning = 4, notice = 5, info = 6 };

void log_line(Severity severity, std::string_view text);

}  // namespace landfix::tools
