#include "platform/doorbell.hpp"

#include <algorithm>
#include <ctime>

#include <poll.h>
#include <unistd.h>

#include "platform/monotonic_clock.hpp"
#include "platform/nanoseconds.hpp"

namespace landfix::platform {

void Doorbell::ring() noexcept {
  constexpr std::uint64_t kOne = 1;
  // Refused only where the count is at its end, and then the other is awake already.
  [[maybe_unused]] const ssize_t written = ::write(event_.number(), &kOne, sizeof kOne);
}

void Doorbell::wait(std::int64_t deadline_mono_ns) noexcept {
  const std::int64_t left_ns = std::max<std::int64_t>(0, deadline_mono_ns - monotonic_ns());
  const timespec left{.tv_sec = left_ns / kNs_per_s, .tv_nsec = left_ns % kNs_per_s};
  pollfd watched{.fd = event_.number(), .events = POLLIN, .revents = 0};
  if (::ppoll(&watched, 1, &left, nullptr) <= 0) return;
  std::uint64_t rings = 0;
  [[maybe_unused]] const ssize_t read = ::read(event_.number(), &rings, sizeof rings);
}

}  // namespace landfix::platform
