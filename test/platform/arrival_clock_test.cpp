#include "platform/arrival_clock.hpp"

#include <gtest/gtest.h>

#include "platform/nanoseconds.hpp"

namespace landfix::platform {
namespace {

constexpr std::int64_t kHour_ns = 3600 * 1000 * kNs_per_ms;
constexpr std::int64_t kUtc_ns = 1'700'000'000'000'000'000;

TEST(ArrivalClock, TellsHowLongAPacketWaited) {
  ArrivalClock clock;
  clock.set(kUtc_ns, 5000 * kNs_per_ms, true);
  EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns - 3 * kNs_per_ms), 4997 * kNs_per_ms);
}

TEST(ArrivalClock, SeesAClockSetByAnHourAsNoDelay) {
  for (const std::int64_t step_ns : {kHour_ns, -kHour_ns, 2 * kNs_per_ms}) {
    // GIVEN a clock that was set since the last read, of which a packet came before and one after
    ArrivalClock clock;
    clock.set(kUtc_ns, 5000 * kNs_per_ms, true);
    clock.set(kUtc_ns + step_ns + 10 * kNs_per_ms, 5010 * kNs_per_ms, false);
    // THEN both are as old as the read
    EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns + 8 * kNs_per_ms), 5010 * kNs_per_ms);
    EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns + step_ns + 9 * kNs_per_ms), 5010 * kNs_per_ms);

    // WHEN the socket still held packets from before, AND was then read empty
    clock.set(kUtc_ns + step_ns + 11 * kNs_per_ms, 5011 * kNs_per_ms, true);
    EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns + 9 * kNs_per_ms), 5011 * kNs_per_ms);

    // THEN stamps are trusted again
    clock.set(kUtc_ns + step_ns + 20 * kNs_per_ms, 5020 * kNs_per_ms, true);
    EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns + step_ns + 17 * kNs_per_ms), 5017 * kNs_per_ms);
  }
}

TEST(ArrivalClock, FollowsAClockThatIsSlewed) {
  ArrivalClock clock;
  clock.set(kUtc_ns, 5000 * kNs_per_ms, true);
  clock.set(kUtc_ns + 1000 * kNs_per_ms, 6000 * kNs_per_ms + kNs_per_ms / 2, true);  // 500 ppm
  EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns + 999 * kNs_per_ms), 5999 * kNs_per_ms + kNs_per_ms / 2);
}

TEST(ArrivalClock, NeverLetsAPacketArriveAfterItWasRead) {
  ArrivalClock clock;
  clock.set(kUtc_ns, 5000 * kNs_per_ms, true);
  EXPECT_EQ(clock.arrived_mono_ns(kUtc_ns + kNs_per_ms / 10), 5000 * kNs_per_ms);
}

}  // namespace
}  // namespace landfix::platform
