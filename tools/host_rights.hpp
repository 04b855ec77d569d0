// What the kernel has to be asked: what this process may do, tried for real, how its clock is kept, how CAN
// is queued.
#pragma once

#include <string>
#include <vector>

#include "platform/realtime_settings.hpp"
#include "tools/host_checks.hpp"

namespace landfix::tools {

/// Starts a thread as each of the daemon's would be, and locks memory for a moment.
[[nodiscard]] std::vector<HostCheck> check_rights(const platform::RealtimeSettings& realtime);
[[nodiscard]] HostCheck check_clock();
/// Whether the interface sends what it is given in turn.
[[nodiscard]] HostCheck check_discipline(const std::string& can_interface);

}  // namespace landfix::tools
