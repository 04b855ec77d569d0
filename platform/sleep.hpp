// Waiting for a moment of the monotonic clock.
#pragma once

#include <cstdint>
#include <ctime>

namespace landfix::platform {

inline void sleep_until(std::int64_t mono_ns) noexcept {
  constexpr std::int64_t kNs_per_s = 1'000'000'000;
  const timespec until{.tv_sec = mono_ns / kNs_per_s, .tv_nsec = mono_ns % kNs_per_s};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

}  // namespace landfix::platform
