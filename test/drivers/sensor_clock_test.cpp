#include "drivers/sensor_clock.hpp"

#include <cstdlib>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace landfix::drivers {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kHourNs = 3600 * kSecondNs;
constexpr std::int64_t kHourUtcNs = 1'700'002'800 * kSecondNs;
static_assert(kHourUtcNs % kHourNs == 0);

TEST(NearestAfterHour, IsAtMostHalfAnHourAway) {
  constexpr std::int64_t kHalfNs = kHourNs / 2;
  for (const std::int64_t near_ns :
       {kHourUtcNs, kHourUtcNs + 1, kHourUtcNs + kHalfNs - 1, kHourUtcNs + kHalfNs, kHourUtcNs + kHalfNs + 1,
        kHourUtcNs + kHourNs - 1}) {
    for (const std::int64_t after_hour_ns :
         {std::int64_t{0}, std::int64_t{1}, kHalfNs - 1, kHalfNs, kHalfNs + 1, kHourNs - 1}) {
      const std::int64_t time_ns = nearest_after_hour(after_hour_ns, near_ns);
      EXPECT_EQ(time_ns % kHourNs, after_hour_ns) << near_ns - kHourUtcNs;
      EXPECT_LE(std::abs(time_ns - near_ns), kHalfNs) << near_ns - kHourUtcNs << ' ' << after_hour_ns;
    }
  }
}

TEST(NearestAfterHour, TakesACountOverTheHourAsItIs) {
  EXPECT_EQ(nearest_after_hour(kHourNs + 60'000'000, kHourUtcNs - 1), kHourUtcNs + 60'000'000);
  EXPECT_EQ(nearest_after_hour(kHourNs + 60'000'000, kHourUtcNs + 1), kHourUtcNs + 60'000'000);
}

TEST(NearestAfterHour, IsNotBefore1970) {
  EXPECT_EQ(nearest_after_hour(kHourNs - 1, 0), kHourNs - 1) << "an hour earlier would be";
  EXPECT_EQ(nearest_after_hour(0, 0), 0);
  EXPECT_EQ(nearest_after_hour(kHourNs - 1, kHourNs), kHourNs - 1);
}

TEST(SensorClock, ExpandsTheHourNearTheTimeOfReceipt) {
  const SensorClock clock;
  EXPECT_EQ(clock.expand_top_of_hour(10'000'000, kHourUtcNs + 12 * kSecondNs), kHourUtcNs + 10 * kSecondNs);
  // Sent just before the hour, received just after it, and the other way about.
  EXPECT_EQ(clock.expand_top_of_hour(3'599'999'000, kHourUtcNs + 1'000'000), kHourUtcNs - 1'000'000);
  EXPECT_EQ(clock.expand_top_of_hour(1000, kHourUtcNs - 1'000'000), kHourUtcNs + 1'000'000);
  // Counted on over the hour.
  EXPECT_EQ(clock.expand_top_of_hour(3'600'060'000, kHourUtcNs + kSecondNs / 10), kHourUtcNs + 60'000'000);
}

TEST(SensorClock, TrustsASynchronisedSensor) {
  SensorClock clock;
  EXPECT_EQ(clock.advance(kHourUtcNs, kHourUtcNs + 2'000'000), ClockVerdict::continues);
  EXPECT_EQ(clock.time_source(), TimeSource::sensor);
  EXPECT_EQ(clock.advance(kHourUtcNs + 1'000'000, kHourUtcNs + 9'000'000), ClockVerdict::continues);
  EXPECT_EQ(clock.to_utc_ns(kHourUtcNs + 1'000'000), kHourUtcNs + 1'000'000);
}

TEST(SensorClock, AnchorsAnUnsynchronisedSensorToThePacketDelayedLeast) {
  SensorClock clock;
  const std::int64_t offset_ns = 100'000 * kSecondNs;
  std::mt19937 random(4);
  std::uniform_int_distribution<std::int64_t> delay_ns(1'000'000, 20'000'000);
  for (std::int64_t i = 0; i < 2000; ++i) {
    const std::int64_t sensor_ns = kHourUtcNs + i * 1'327'104;
    EXPECT_EQ(clock.advance(sensor_ns, sensor_ns + offset_ns + (i == 500 ? 500'000 : delay_ns(random))),
              ClockVerdict::continues);
  }
  EXPECT_EQ(clock.time_source(), TimeSource::receive);
  const std::int64_t late_ns = clock.to_utc_ns(kHourUtcNs) - kHourUtcNs - offset_ns;
  EXPECT_GE(late_ns, 500'000);
  EXPECT_LE(late_ns, 500'000 + 2 * 100'000) << "2 s later it has leaked by 100 ppm";
}

TEST(SensorClock, FollowsTheDriftOfTheCrystals) {
  SensorClock clock;
  std::int64_t late_ns = 0;
  for (int second = 0; second < 3600; ++second) {
    const std::int64_t sensor_ns = kHourUtcNs + second * kSecondNs;
    const std::int64_t receive_ns = sensor_ns + 5 * kHourNs + second * 50'000;  // 50 ppm slow
    EXPECT_EQ(clock.advance(sensor_ns, receive_ns), ClockVerdict::continues);
    late_ns = receive_ns - clock.to_utc_ns(sensor_ns);
  }
  EXPECT_EQ(late_ns, 0);
}

TEST(SensorClock, StartsAnewWhenAClockIsSet) {
  SensorClock clock;
  EXPECT_EQ(clock.advance(kHourUtcNs, kHourUtcNs + 1000 * kSecondNs), ClockVerdict::continues);
  EXPECT_EQ(clock.time_source(), TimeSource::receive);
  const std::int64_t now_ns = kHourUtcNs + 1001 * kSecondNs;
  // The sensor has found its satellites.
  EXPECT_EQ(clock.advance(now_ns - 1'000'000, now_ns), ClockVerdict::doubtful);
  EXPECT_EQ(clock.advance(now_ns, now_ns + 1'000'000), ClockVerdict::stepped);
  EXPECT_EQ(clock.time_source(), TimeSource::sensor);
  EXPECT_EQ(clock.to_utc_ns(now_ns), now_ns);
  // The computer was set.
  EXPECT_EQ(clock.advance(now_ns + 1'000'000, now_ns - 50 * kSecondNs), ClockVerdict::doubtful);
  EXPECT_EQ(clock.advance(now_ns + 2'000'000, now_ns - 50 * kSecondNs), ClockVerdict::stepped);
  EXPECT_EQ(clock.time_source(), TimeSource::receive);
  // Back, by little.
  EXPECT_EQ(clock.advance(now_ns - 20'000'000, now_ns - 50 * kSecondNs), ClockVerdict::doubtful);
  EXPECT_EQ(clock.advance(now_ns - 19'000'000, now_ns - 50 * kSecondNs), ClockVerdict::stepped);
}

TEST(SensorClock, IsNotMovedByOnePacketOfAnotherTime) {
  SensorClock clock;
  EXPECT_EQ(clock.advance(kHourUtcNs, kHourUtcNs + 2'000'000), ClockVerdict::continues);
  for (int i = 1; i < 100; ++i) {
    const std::int64_t now_ns = kHourUtcNs + i * 1'000'000;
    if (i % 10 == 0) {
      EXPECT_EQ(clock.advance(now_ns + (i % 20 == 0 ? -1800 : 1800) * kSecondNs, now_ns),
                ClockVerdict::doubtful);
    }
    EXPECT_EQ(clock.advance(now_ns, now_ns + 2'000'000), ClockVerdict::continues);
    EXPECT_EQ(clock.time_source(), TimeSource::sensor);
    EXPECT_EQ(clock.to_utc_ns(now_ns), now_ns);
  }
  // Nor by two that do not agree.
  const std::int64_t now_ns = kHourUtcNs + kSecondNs;
  EXPECT_EQ(clock.advance(now_ns + 100 * kSecondNs, now_ns), ClockVerdict::doubtful);
  EXPECT_EQ(clock.advance(now_ns + 200 * kSecondNs, now_ns), ClockVerdict::doubtful);
  EXPECT_EQ(clock.advance(now_ns, now_ns), ClockVerdict::continues);
}

TEST(SensorClock, BelievesTheSatellitesMoreThanTheReceiversClock) {
  // The receiver's clock is 5 h 20 min slow: it guesses another hour, and the sensor seems far from UTC.
  constexpr std::int64_t kSlowNs = 5 * kHourNs + 1200 * kSecondNs;
  SensorClock clock;
  const auto packet_at = [&](std::int64_t utc_ns) {
    const auto counter_us = static_cast<std::uint32_t>(utc_ns % kHourNs / 1000);
    const std::int64_t receive_utc_ns = utc_ns - kSlowNs + 1'000'000;
    const std::int64_t sensor_ns = clock.expand_top_of_hour(counter_us, receive_utc_ns);
    EXPECT_EQ(clock.advance(sensor_ns, receive_utc_ns), ClockVerdict::continues);
    return clock.to_utc_ns(sensor_ns);
  };
  EXPECT_EQ(packet_at(kHourUtcNs) - kHourUtcNs, 1'000'000 - kSlowNs);
  EXPECT_EQ(clock.time_source(), TimeSource::receive);
  EXPECT_TRUE(clock.learn_utc(kHourUtcNs + 500'000, kHourUtcNs - kSlowNs + 1'500'000));
  EXPECT_EQ(packet_at(kHourUtcNs + 1'000'000), kHourUtcNs + 1'000'000);
  EXPECT_EQ(clock.time_source(), TimeSource::sensor);
  EXPECT_FALSE(clock.learn_utc(kHourUtcNs + 1'500'000, kHourUtcNs - kSlowNs + 2'500'000)) << "no news";

  SensorClock from_the_start;
  EXPECT_FALSE(from_the_start.learn_utc(kHourUtcNs, kHourUtcNs - kSlowNs));
  EXPECT_EQ(from_the_start.expand_top_of_hour(2000, kHourUtcNs - kSlowNs), kHourUtcNs + 2'000'000);
}

TEST(SensorClock, CountsOnThroughTheHourWhereverTheSensorStands) {
  // Half an hour from UTC, where the nearest hour is a matter of microseconds.
  SensorClock clock;
  std::int64_t last_ns = 0;
  std::mt19937 random(5);
  std::uniform_int_distribution<std::int64_t> delay_ns(0, 5'000'000);
  for (int i = 0; i < 100'000; ++i) {
    const auto counter_us = static_cast<std::uint32_t>(
        (3'590'000'000ULL + static_cast<std::uint64_t>(i) * 1000U) % 3'600'000'000U);
    const std::int64_t receive_ns = kHourUtcNs + 1790 * kSecondNs + i * 1'000'000LL + delay_ns(random);
    const std::int64_t sensor_ns = clock.expand_top_of_hour(counter_us, receive_ns);
    EXPECT_EQ(clock.advance(sensor_ns, receive_ns), ClockVerdict::continues) << i;
    if (i > 0) {
      ASSERT_EQ(sensor_ns - last_ns, 1'000'000) << i;
    }
    last_ns = sensor_ns;
  }
}

TEST(SensorClock, IsNotOverthrownByWildTimes) {
  SensorClock clock;
  std::mt19937_64 random(6);
  std::uniform_int_distribution<std::int64_t> any(std::numeric_limits<std::int64_t>::min(),
                                                  std::numeric_limits<std::int64_t>::max());
  for (int i = 0; i < 10'000; ++i) {
    const std::int64_t receive_ns = any(random);
    const auto counter_us = static_cast<std::uint32_t>(random() % 3'601'000'000U);
    const std::int64_t sensor_ns = clock.expand_top_of_hour(counter_us, receive_ns);
    static_cast<void>(clock.advance(sensor_ns, receive_ns));
    if (i % 100 == 0) static_cast<void>(clock.learn_utc(any(random), receive_ns));
    EXPECT_LE(clock.to_utc_ns(sensor_ns), SensorClock::kLatestNs + kHourNs);
  }
}

}  // namespace
}  // namespace landfix::drivers
