// The clock that durations are measured with: it never jumps, and reading it is no system call.
#pragma once

#include <chrono>
#include <cstdint>

namespace landfix::platform {

[[nodiscard]] inline std::int64_t monotonic_ns() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace landfix::platform
