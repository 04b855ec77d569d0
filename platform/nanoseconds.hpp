// The unit of every stamp and every duration on the hot path.
#pragma once

#include <cstdint>

namespace landfix::platform {

inline constexpr std::int64_t kNs_per_ms = 1'000'000;
inline constexpr std::int64_t kNs_per_s = 1'000'000'000;

}  // namespace landfix::platform
