#include "platform/watchdog.hpp"

#include <array>

#include <gtest/gtest.h>

namespace landfix::platform {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;

class WatchdogTest : public testing::Test {
 protected:
  Heartbeat rx_, solve_;
  std::array<WatchedThread, 2> threads_{
      {{"rx", 200 * kMillisecond_ns, &rx_}, {"solve", 500 * kMillisecond_ns, &solve_}}};
};

TEST_F(WatchdogTest, NoneIsLateWithinItsOwnBudget) {
  rx_.mark(1'000 * kMillisecond_ns);
  solve_.mark(700 * kMillisecond_ns);
  EXPECT_EQ(find_late(threads_, 1'200 * kMillisecond_ns), nullptr);
}

TEST_F(WatchdogTest, ThatWhichIsOverItsBudgetIsNamed) {
  rx_.mark(1'000 * kMillisecond_ns);
  solve_.mark(700 * kMillisecond_ns);
  ASSERT_NE(find_late(threads_, 1'200 * kMillisecond_ns + 1), nullptr);
  EXPECT_EQ(find_late(threads_, 1'200 * kMillisecond_ns + 1)->name, "rx");
  rx_.mark(1'200 * kMillisecond_ns);
  ASSERT_NE(find_late(threads_, 1'200 * kMillisecond_ns + 1), nullptr);
  EXPECT_EQ(find_late(threads_, 1'200 * kMillisecond_ns + 1)->name, "solve");
}

TEST_F(WatchdogTest, AMarkMakesGood) {
  rx_.mark(0);
  solve_.mark(0);
  EXPECT_NE(find_late(threads_, 600 * kMillisecond_ns), nullptr);
  rx_.mark(600 * kMillisecond_ns);
  solve_.mark(600 * kMillisecond_ns);
  EXPECT_EQ(find_late(threads_, 600 * kMillisecond_ns), nullptr);
}

TEST_F(WatchdogTest, NoThreadIsNeverLate) { EXPECT_EQ(find_late({}, 1), nullptr); }

}  // namespace
}  // namespace landfix::platform
