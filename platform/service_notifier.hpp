// Tells systemd how the service is (sd_notify). Does nothing where no systemd asked for it, and in a build
// without libsystemd. Not for a real-time thread: each call sends a datagram.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace landfix::platform {

class ServiceNotifier {
 public:
  /// Reads the environment that systemd gives: NOTIFY_SOCKET, WATCHDOG_USEC, WATCHDOG_PID.
  ServiceNotifier();

  /// False where nobody listens.
  [[nodiscard]] bool is_listened_to() const noexcept { return is_listened_to_; }
  /// How often alive() is due: half of what systemd waits for; nothing where it does not.
  [[nodiscard]] std::optional<std::int64_t> alive_period_ns() const noexcept { return alive_period_ns_; }

  /// The start is over; `status` is one line for `systemctl status`.
  void ready(std::string_view status) const;
  void status(std::string_view status) const;
  /// Every thread is within its budget.
  void alive() const;
  void stopping(std::string_view status) const;

 private:
  bool is_listened_to_ = false;
  std::optional<std::int64_t> alive_period_ns_;
};

}  // namespace landfix::platform
