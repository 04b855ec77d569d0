// Calendar to Unix seconds, without time zones and without the C library's hidden state.
#pragma once

#include <cstdint>
#include <optional>

namespace landfix::drivers {

/// Date and time as packets hold them; whatever they hold.
struct CivilTime {
  int year = 0;    ///< 2000 to 2099
  int month = 0;   ///< 1 to 12
  int day = 0;     ///< 1 to 31
  int hour = 0;    ///< 0 to 23
  int minute = 0;  ///< 0 to 59
  int second = 0;  ///< 0 to 59
};

/// Days from 1970-01-01 in the Gregorian calendar.
[[nodiscard]] constexpr std::int64_t days_from_civil(int year, int month, int day) noexcept {
  // Years that begin in March, so that the leap day is the last; 719468 days lie before 1970-01-01.
  const std::int64_t shifted_year = month <= 2 ? year - 1 : year;
  const std::int64_t day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return 365 * shifted_year + shifted_year / 4 - shifted_year / 100 + shifted_year / 400 + day_of_year -
         719'468;
}

/// Unix seconds UTC; nothing if it is no date or time.
[[nodiscard]] constexpr std::optional<std::int64_t> unix_seconds(const CivilTime& time) noexcept {
  if (time.year < 2000 || time.year > 2099 || time.month < 1 || time.month > 12) return std::nullopt;
  if (time.hour < 0 || time.hour > 23 || time.minute < 0 || time.minute > 59) return std::nullopt;
  if (time.second < 0 || time.second > 59) return std::nullopt;
  const std::int64_t day = days_from_civil(time.year, time.month, time.day);
  const std::int64_t next_month =
      time.month == 12 ? days_from_civil(time.year + 1, 1, 1) : days_from_civil(time.year, time.month + 1, 1);
  if (time.day < 1 || day >= next_month) return std::nullopt;
  return ((day * 24 + time.hour) * 60 + time.minute) * 60 + time.second;
}

static_assert(days_from_civil(1970, 1, 1) == 0);
static_assert(unix_seconds({.year = 2000, .month = 2, .day = 29}) == 951'782'400);

}  // namespace landfix::drivers
