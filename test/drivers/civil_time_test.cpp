#include "drivers/civil_time.hpp"

#include <chrono>
#include <utility>

#include <gtest/gtest.h>

namespace landfix::drivers {
namespace {

TEST(CivilTime, IsThatOfTheStandardLibraryForEveryDayThereMayBe) {
  using std::chrono::sys_days, std::chrono::year_month_day, std::chrono::January;
  std::int64_t days = 0;
  for (sys_days day = January / 1 / 2000; day < sys_days(January / 1 / 2100); day += std::chrono::days(1)) {
    const year_month_day date(day);
    const CivilTime time{.year = static_cast<int>(date.year()),
                         .month = static_cast<int>(static_cast<unsigned>(date.month())),
                         .day = static_cast<int>(static_cast<unsigned>(date.day()))};
    ASSERT_EQ(unix_seconds(time), std::int64_t{day.time_since_epoch().count()} * 86'400)
        << time.year << '-' << time.month << '-' << time.day;
    ++days;
  }
  EXPECT_EQ(days, 36'525);
}

TEST(CivilTime, CountsHoursMinutesAndSeconds) {
  EXPECT_EQ(unix_seconds({.year = 2024, .month = 12, .day = 31, .hour = 23, .minute = 59, .second = 59}),
            1'735'689'599);
}

TEST(CivilTime, RefusesWhatIsNoDateOrTime) {
  constexpr CivilTime kGood{.year = 2023, .month = 4, .day = 30, .hour = 23, .minute = 59, .second = 59};
  ASSERT_TRUE(unix_seconds(kGood).has_value());
  const auto is_refused = [&](int CivilTime::*field, int value) {
    CivilTime time = kGood;
    time.*field = value;
    return !unix_seconds(time).has_value();
  };
  for (const auto& [field, value] : std::initializer_list<std::pair<int CivilTime::*, int>>{
           {&CivilTime::year, 1999},
           {&CivilTime::year, 2100},
           {&CivilTime::month, 0},
           {&CivilTime::month, 13},
           {&CivilTime::month, 2},  // the 30th of February
           {&CivilTime::day, 0},
           {&CivilTime::day, 31},
           {&CivilTime::hour, -1},
           {&CivilTime::hour, 24},
           {&CivilTime::minute, -1},
           {&CivilTime::minute, 60},
           {&CivilTime::second, -1},
           {&CivilTime::second, 60},  // Unix time knows no leap second
       }) {
    EXPECT_TRUE(is_refused(field, value)) << value;
  }
  EXPECT_FALSE(unix_seconds({.year = 2023, .month = 2, .day = 29}).has_value());
  EXPECT_TRUE(unix_seconds({.year = 2024, .month = 2, .day = 29}).has_value());
}

}  // namespace
}  // namespace landfix::drivers
