#include "platform/service_notifier.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include <fmt/format.h>
#if LANDFIX_HAS_SYSTEMD
#include <systemd/sd-daemon.h>
#endif

namespace landfix::platform {
namespace {

void send(const std::string& lines) {
#if LANDFIX_HAS_SYSTEMD
  // A message that is lost is followed by the next; nobody could be told anyway.
  (void)::sd_notify(0, lines.c_str());
#else
  (void)lines;
#endif
}

/// A line of its own, whatever the text: a second one would be taken for another message.
std::string status_line(std::string_view status) {
  std::string line = fmt::format("STATUS={}", status);
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line;
}

std::optional<std::int64_t> half_of_watchdog_ns() {
#if LANDFIX_HAS_SYSTEMD
  constexpr std::int64_t kHalfMicrosecond_ns = 500;
  std::uint64_t period_us = 0;
  if (::sd_watchdog_enabled(0, &period_us) > 0) {
    return static_cast<std::int64_t>(period_us) * kHalfMicrosecond_ns;
  }
#endif
  return std::nullopt;
}

}  // namespace

ServiceNotifier::ServiceNotifier()
    : is_listened_to_(LANDFIX_HAS_SYSTEMD && std::getenv("NOTIFY_SOCKET") != nullptr),
      alive_period_ns_(is_listened_to_ ? half_of_watchdog_ns() : std::nullopt) {}

void ServiceNotifier::ready(std::string_view status) const {
  if (is_listened_to_) send("READY=1\n" + status_line(status));
}

void ServiceNotifier::status(std::string_view status) const {
  if (is_listened_to_) send(status_line(status));
}

void ServiceNotifier::alive() const {
  if (is_listened_to_) send("WATCHDOG=1");
}

void ServiceNotifier::stopping(std::string_view status) const {
  if (is_listened_to_) send("STOPPING=1\n" + status_line(status));
}

}  // namespace landfix::platform
