#include "platform/send_schedule.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/nanoseconds.hpp"

namespace landfix::platform {
namespace {

struct Sent {
  std::vector<std::int64_t> at_ns;
  int fresh = 0;  ///< that went out with a sweep's pose within 1 ms of it
};

/// Two seconds in steps of 0.1 ms, with a sweep in each 100 ms, by turns on time and `late_ms` late.
[[nodiscard]] Sent run(double rate_hz, std::int64_t late_ms) {
  SendSchedule schedule(rate_hz);
  Sent sent;
  std::int64_t last_fix_ns = -1000 * kNs_per_ms;
  int sweeps = 0;
  for (std::int64_t now = 0; now < 2000 * kNs_per_ms; now += kNs_per_ms / 10) {
    if (now >= (50 + 100 * sweeps + sweeps % 2 * late_ms) * kNs_per_ms) {
      schedule.take_fix(now);
      last_fix_ns = now;
      ++sweeps;
    }
    if (now < schedule.due_ns()) continue;
    schedule.sent(now);
    sent.at_ns.push_back(now);
    if (now - last_fix_ns < kNs_per_ms) ++sent.fresh;
  }
  return sent;
}

[[nodiscard]] std::vector<std::int64_t> gaps_ms(const Sent& sent) {
  std::vector<std::int64_t> gaps;
  for (std::size_t i = 6; i < sent.at_ns.size(); ++i)
    gaps.push_back((sent.at_ns[i] - sent.at_ns[i - 1]) / kNs_per_ms);
  return gaps;
}

TEST(SendSchedule, SendsEverySweepOnceAtTheSweepRate) {
  const Sent sent = run(10.0, 0);
  EXPECT_NEAR(static_cast<double>(sent.at_ns.size()), 20.0, 2.0);
  EXPECT_GE(sent.fresh, 19);
  EXPECT_THAT(gaps_ms(sent), ::testing::Each(100));
}

TEST(SendSchedule, WaitsForSweepsThatComeLate) {
  const Sent sent = run(10.0, 20);
  EXPECT_GE(sent.fresh, 18);
  EXPECT_THAT(gaps_ms(sent), ::testing::Each(::testing::AllOf(::testing::Ge(75), ::testing::Le(130))));
}

TEST(SendSchedule, FillsTheTimeBetweenSweepsAtAHigherRate) {
  const Sent sent = run(50.0, 0);
  EXPECT_NEAR(static_cast<double>(sent.at_ns.size()), 100.0, 3.0);
  EXPECT_GE(sent.fresh, 18);
  EXPECT_THAT(gaps_ms(sent), ::testing::Each(::testing::AllOf(::testing::Ge(10), ::testing::Le(25))));
}

TEST(SendSchedule, KeepsItsRateWithoutSweeps) {
  SendSchedule schedule(20.0);
  int sent = 0;
  for (std::int64_t now = 0; now < 1000 * kNs_per_ms; now += kNs_per_ms) {
    if (now < schedule.due_ns()) continue;
    schedule.sent(now);
    ++sent;
  }
  EXPECT_EQ(sent, 20);
}

}  // namespace
}  // namespace landfix::platform
