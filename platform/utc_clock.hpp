// The clock that stamps are compared with: Unix nanoseconds UTC. It may be set; durations are measured with
// monotonic_clock.hpp.
#pragma once

#include <chrono>
#include <cstdint>

namespace landfix::platform {

[[nodiscard]] inline std::int64_t utc_ns() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace landfix::platform
