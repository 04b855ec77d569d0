#include "drivers/hesai/tail_time.hpp"

#include <cstddef>

#include "drivers/big_endian.hpp"
#include "drivers/civil_time.hpp"

namespace landfix::drivers::hesai {
namespace {

constexpr std::uint32_t kLatestMicrosecond = 1'000'000;  // the manuals include the upper end
constexpr std::int64_t kYear2100 = 4'102'444'800;

int year_of(int count) noexcept {
  // The manuals count from 2000; recorded units of the same models count from 1900.
  return count < 100 ? 2000 + count : 1900 + count;
}

}  // namespace

std::optional<std::int64_t> unix_seconds_of(const WireTail& tail) noexcept {
  const auto field = [&tail](std::size_t i) { return std::to_integer<int>(tail.date[i]); };
  if (field(0) == 0 && field(1) == 0) {
    // No date has month 0: newer firmware counts Unix seconds in the other four, most significant first.
    const auto seconds = load_big_endian<std::uint32_t>(&tail.date[2]);
    if (seconds == 0 || seconds >= kYear2100) return std::nullopt;
    return seconds;
  }
  return unix_seconds({.year = year_of(field(0)),
                       .month = field(1),
                       .day = field(2),
                       .hour = field(3),
                       .minute = field(4),
                       .second = field(5)});
}

std::optional<std::int64_t> packed_ns_of(const WireTail& tail) noexcept {
  const auto microseconds = load_little_endian<std::uint32_t>(tail.microseconds);
  const auto seconds = unix_seconds_of(tail);
  if (!seconds || microseconds > kLatestMicrosecond) return std::nullopt;
  return *seconds * 1'000'000'000 + std::int64_t{microseconds} * 1000;
}

}  // namespace landfix::drivers::hesai
