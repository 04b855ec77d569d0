// What this process may do, tried for real, and how its clock is kept.
#pragma once

#include <vector>

#include "platform/realtime_settings.hpp"
#include "tools/host_checks.hpp"

namespace landfix::tools {

/// Starts a thread as each of the daemon's would be, and locks memory for a moment.
[[nodiscard]] std::vector<HostCheck> check_rights(const platform::RealtimeSettings& realtime);
[[nodiscard]] HostCheck check_clock();

}  // namespace landfix::tools
