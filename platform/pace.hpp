// When the packets of a capture are due.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace landfix::platform {

/// Real time after the first packet, from the recorded time after it and how many times as fast it shall go.
[[nodiscard]] inline std::int64_t paced_ns(std::int64_t recorded_ns, double speed) noexcept {
  constexpr double kCentury_ns = 3.2e18;  // a damaged stamp may lie anywhere
  return std::llround(std::clamp(static_cast<double>(recorded_ns) / speed, -kCentury_ns, kCentury_ns));
}

}  // namespace landfix::platform
