#include "platform/realtime_settings.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "platform/toml_section.hpp"

namespace landfix::platform {
namespace {

/// In the order of RealtimeMode.
constexpr std::array<std::string_view, 3> kModeNames{"auto", "required", "off"};
constexpr Range<int> kPriorities{1, 98};  // 99 is for what the kernel itself depends on
constexpr Range<int> kCores{-1, 1023};

auto find_mode(std::string_view name) { return std::find(kModeNames.begin(), kModeNames.end(), name); }

}  // namespace

void read_realtime(TomlSection section, RealtimeSettings& realtime) {
  std::string mode(kModeNames[static_cast<std::size_t>(realtime.mode)]);
  section.read(
      "mode", mode, [](std::string_view name) { return find_mode(name) != kModeNames.end(); },
      fmt::format("one of {}", fmt::join(kModeNames, ", ")));
  realtime.mode = static_cast<RealtimeMode>(find_mode(mode) - kModeNames.begin());
  section.read("lock_memory", realtime.lock_memory);
  section.read("rx_priority", realtime.rx.priority, kPriorities);
  section.read("rx_core", realtime.rx.core, kCores);
  section.read("solve_priority", realtime.solve.priority, kPriorities);
  section.read("solve_core", realtime.solve.core, kCores);
  section.read("tx_priority", realtime.tx.priority, kPriorities);
  section.read("tx_core", realtime.tx.core, kCores);
  section.finish();
}

}  // namespace landfix::platform
