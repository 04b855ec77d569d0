// The time in a packet's tail.
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/hesai/wire.hpp"

namespace landfix::drivers::hesai {

/// Unix seconds of the tail's six bytes; nothing if they are no date between 1970 and 2099.
[[nodiscard]] std::optional<std::int64_t> unix_seconds_of(const WireTail& tail) noexcept;

/// Sensor time at which the packet was finished, Unix nanoseconds; nothing if it is no time.
[[nodiscard]] std::optional<std::int64_t> packed_ns_of(const WireTail& tail) noexcept;

}  // namespace landfix::drivers::hesai
