// The packet that says whether the sensor has its time from satellites (user manuals, section 3.2).
//
//   0       2         8         14       18    ...   506        507       508
//   | FF EE | date    | time    | u32 us | NMEA ... | position | pulse   | reserved |
//   date: year, month, day; time: second, minute, hour; each two ASCII digits, the units first
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace landfix::drivers::hesai {

/// Once a second with a GPS receiver as clock, none with PTP.
inline constexpr std::size_t kGpsBytes = 512;

[[nodiscard]] bool is_gps_packet(std::span<const std::byte> payload) noexcept;

/// UTC by the satellites, Unix nanoseconds; nothing while position or pulse are not valid, or if it is no
/// date. The NMEA sentence says nothing more about time, so it is not read.
[[nodiscard]] std::optional<std::int64_t> gps_utc_ns(std::span<const std::byte, kGpsBytes> packet) noexcept;

}  // namespace landfix::drivers::hesai
