#include "platform/sweep_schedule.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "platform/nanoseconds.hpp"

namespace landfix::platform {
namespace {

constexpr std::int64_t kHour = 3'600'000 * kNs_per_ms;
constexpr std::int64_t kFirst_utc_ns = 1'700'000'000'000 * kNs_per_ms;
constexpr std::int64_t kReceived = kFirst_utc_ns - 7 * kHour;  // the sensor has a clock of its own

class Schedule : public testing::Test {
 protected:
  /// Sweeps every 100 ms, the last with stamp kFirst_utc_ns, received at kReceived.
  void see_sweeps(int count) {
    for (int i = 1 - count; i <= 0; ++i)
      schedule_.came(kFirst_utc_ns + i * 100 * kNs_per_ms,
                     kReceived + i * 100 * kNs_per_ms + i % 3 * kNs_per_ms);
  }
  [[nodiscard]] std::vector<MissingSweep> missing(std::int64_t now) {
    std::vector<MissingSweep> all;
    while (const auto sweep = schedule_.next_missing(now)) {
      all.push_back(*sweep);
      if (all.size() > 100) break;
    }
    return all;
  }

  SweepSchedule schedule_{200 * kNs_per_ms, 1000 * kNs_per_ms};
};

TEST_F(Schedule, MissesNothingBeforeTheFirstSweep) { EXPECT_TRUE(missing(kReceived + kHour).empty()); }

TEST_F(Schedule, MissesASweepHalfAPeriodAfterItWasDue) {
  see_sweeps(3);
  EXPECT_EQ(schedule_.period_ns(), 100 * kNs_per_ms);
  EXPECT_TRUE(missing(kReceived + 149 * kNs_per_ms).empty());
  const auto first = missing(kReceived + 151 * kNs_per_ms);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].stamp_utc_ns, kFirst_utc_ns + 100 * kNs_per_ms);
  EXPECT_FALSE(first[0].is_silence);
  EXPECT_TRUE(missing(kReceived + 249 * kNs_per_ms).empty());
  EXPECT_EQ(missing(kReceived + 251 * kNs_per_ms).size(), 1U);
}

TEST_F(Schedule, GivesARegularGridThatNeverRunsPastNow) {
  see_sweeps(10);
  std::int64_t last = kFirst_utc_ns;
  int predicted = 0;
  int silent = 0;
  for (std::int64_t t = 0; t < 4000 * kNs_per_ms; t += 3 * kNs_per_ms) {
    for (const MissingSweep& sweep : missing(kReceived + t)) {
      EXPECT_EQ((sweep.stamp_utc_ns - kFirst_utc_ns) % (100 * kNs_per_ms), 0);
      EXPECT_GT(sweep.stamp_utc_ns, last);
      EXPECT_LE(sweep.stamp_utc_ns - kFirst_utc_ns, t);
      EXPECT_EQ(sweep.is_silence, sweep.stamp_utc_ns - kFirst_utc_ns > 1000 * kNs_per_ms);
      last = sweep.stamp_utc_ns;
      ++(sweep.is_silence ? silent : predicted);
    }
  }
  EXPECT_EQ(predicted, 10);
  EXPECT_EQ(silent, 6);  // from 1.15 s, twice a second
}

TEST_F(Schedule, WaitsForTheSlowestTurnUntilTwoSweepsWereSeen) {
  see_sweeps(1);
  EXPECT_TRUE(missing(kReceived + 299 * kNs_per_ms).empty());
  const auto first = missing(kReceived + 301 * kNs_per_ms);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].stamp_utc_ns, kFirst_utc_ns + 200 * kNs_per_ms);
}

TEST_F(Schedule, LearnsThePeriodDespiteSplintersAndLostSweeps) {
  std::int64_t t = 0;
  for (const std::int64_t step : {50, 50, 1, 49, 50, 100, 50, 50, 3000, 50}) {
    t += step * kNs_per_ms;
    schedule_.came(kFirst_utc_ns + t, kReceived + t);
  }
  EXPECT_EQ(schedule_.period_ns(), 50 * kNs_per_ms);
}

TEST_F(Schedule, StartsAnewWithEverySweep) {
  see_sweeps(5);
  EXPECT_EQ(missing(kReceived + 360 * kNs_per_ms).size(), 3U);
  schedule_.came(kFirst_utc_ns + 380 * kNs_per_ms, kReceived + 380 * kNs_per_ms);
  EXPECT_TRUE(missing(kReceived + 529 * kNs_per_ms).empty());
  const auto next = missing(kReceived + 531 * kNs_per_ms);
  ASSERT_EQ(next.size(), 1U);
  EXPECT_EQ(next[0].stamp_utc_ns, kFirst_utc_ns + 480 * kNs_per_ms);
}

TEST_F(Schedule, AClockThatIsSetForwardGivesASecondOfSweepsAtMost) {
  see_sweeps(5);
  const auto all = missing(kReceived + kHour);
  ASSERT_EQ(all.size(), 11U);
  EXPECT_TRUE(all.back().is_silence);
  EXPECT_EQ(all.back().stamp_utc_ns, kFirst_utc_ns + kHour - 100 * kNs_per_ms);
  schedule_.came(kFirst_utc_ns + 100 * kNs_per_ms, kReceived + kHour);
  EXPECT_TRUE(missing(kReceived + kHour + 149 * kNs_per_ms).empty());
}

TEST_F(Schedule, AClockThatIsSetBackDoesNotHideASilence) {
  see_sweeps(5);
  EXPECT_TRUE(missing(kReceived + 50 * kNs_per_ms).empty());
  EXPECT_TRUE(missing(kReceived - kHour).empty());
  EXPECT_TRUE(missing(kReceived - kHour + 99 * kNs_per_ms).empty());
  const auto first = missing(kReceived - kHour + 101 * kNs_per_ms);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].stamp_utc_ns, kFirst_utc_ns + 100 * kNs_per_ms);
}

TEST_F(Schedule, PacketsALittleOutOfOrderAreNoClockThatWasSet) {
  see_sweeps(5);
  for (std::int64_t t = 0; t < 148 * kNs_per_ms; t += kNs_per_ms) {
    EXPECT_TRUE(missing(kReceived + t).empty());
    EXPECT_TRUE(missing(kReceived + t - 20 * kNs_per_ms).empty());
  }
}

TEST_F(Schedule, BearsAnyStamp) {
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t stamp : {kMin, std::int64_t{0}, kMax}) {
    for (const std::int64_t received : {kMin, std::int64_t{0}, kMax}) {
      for (const std::int64_t now : {kMin, std::int64_t{0}, kMax}) {
        schedule_.came(stamp, received);
        EXPECT_LE(missing(now).size(), 11U);
      }
    }
  }
}

}  // namespace
}  // namespace landfix::platform
