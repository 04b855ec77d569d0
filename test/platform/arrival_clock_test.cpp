#include "platform/arrival_clock.hpp"

#include <gtest/gtest.h>

namespace landfix::platform {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kHour_ns = 3600 * 1000 * kMs;
constexpr std::int64_t kUtc_ns = 1'700'000'000'000'000'000;

TEST(ArrivalClock, TellsHowLongAPacketWaited) {
  ArrivalClock clock;
  clock.set(kUtc_ns, 5000 * kMs, true);
  EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns - 3 * kMs), 4997 * kMs);
}

TEST(ArrivalClock, SeesAClockSetByAnHourAsNoDelay) {
  for (const std::int64_t step_ns : {kHour_ns, -kHour_ns, 2 * kMs}) {
    // GIVEN a clock that was set since the last read, of which a packet came before and one after
    ArrivalClock clock;
    clock.set(kUtc_ns, 5000 * kMs, true);
    clock.set(kUtc_ns + step_ns + 10 * kMs, 5010 * kMs, false);
    // THEN both are as old as the read
    EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns + 8 * kMs), 5010 * kMs);
    EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns + step_ns + 9 * kMs), 5010 * kMs);

    // WHEN the socket still held packets from before, AND was then read empty
    clock.set(kUtc_ns + step_ns + 11 * kMs, 5011 * kMs, true);
    EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns + 9 * kMs), 5011 * kMs);

    // THEN stamps are trusted again
    clock.set(kUtc_ns + step_ns + 20 * kMs, 5020 * kMs, true);
    EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns + step_ns + 17 * kMs), 5017 * kMs);
  }
}

TEST(ArrivalClock, FollowsAClockThatIsSlewed) {
  ArrivalClock clock;
  clock.set(kUtc_ns, 5000 * kMs, true);
  clock.set(kUtc_ns + 1000 * kMs, 6000 * kMs + kMs / 2, true);  // 500 ppm
  EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns + 999 * kMs), 5999 * kMs + kMs / 2);
}

TEST(ArrivalClock, NeverLetsAPacketArriveAfterItWasRead) {
  ArrivalClock clock;
  clock.set(kUtc_ns, 5000 * kMs, true);
  EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns + kMs / 10), 5000 * kMs);
}

}  // namespace
}  // namespace landfix::platform
