// Sleeping to a moment, not for a while: being late once makes nothing else late.
#pragma once

#include <cerrno>
#include <cstdint>
#include <ctime>

#include "platform/nanoseconds.hpp"

namespace landfix::platform {

inline void sleep_until(std::int64_t deadline_mono_ns) noexcept {
  const timespec deadline{.tv_sec = deadline_mono_ns / kNs_per_s, .tv_nsec = deadline_mono_ns % kNs_per_s};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == EINTR) {
  }
}

}  // namespace landfix::platform
