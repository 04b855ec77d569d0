#include "drivers/packet_history.hpp"

#include <gtest/gtest.h>

namespace landfix::drivers {
namespace {

TEST(PacketHistory, KnowsNothingAtFirst) {
  const PacketHistory history;
  EXPECT_FALSE(history.contains(0)) << "a time like any other";
  EXPECT_FALSE(history.contains(1'700'000'000'000'000'000));
}

TEST(PacketHistory, RemembersTheLastSixteenTimes) {
  PacketHistory history;
  for (std::int64_t time_ns = 0; time_ns < 40; ++time_ns) history.insert(time_ns);
  for (std::int64_t time_ns = 24; time_ns < 40; ++time_ns) EXPECT_TRUE(history.contains(time_ns)) << time_ns;
  EXPECT_FALSE(history.contains(23));
  EXPECT_FALSE(history.contains(40));
}

}  // namespace
}  // namespace landfix::drivers
