#include "drivers/velodyne/hdl64_clock.hpp"

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace landfix::drivers::velodyne {
namespace {

constexpr std::int64_t kStart_utc_ns = 1'404'833'944'000'000'000;
constexpr std::int64_t kTurn_ns = 100'000'000;

/// The azimuth that the encoder shows, in steps of 0.09 deg.
std::uint16_t azimuth_at(std::int64_t since_ns) {
  const auto steps = (since_ns % kTurn_ns) * 4000 / kTurn_ns;
  return static_cast<std::uint16_t>(9 * steps);
}

TEST(Hdl64S1Clock, IsEvenWhereReceiptIsNot) {
  Hdl64S1Clock clock;
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::int64_t> delay_ns(0, 400'000);
  // The sensor's crystal is 100 ppm slow.
  constexpr std::int64_t kTrue_ns = Hdl64S1Clock::kPacketNs + 38;
  std::int64_t before_ns = 0;
  for (std::int64_t i = 0; i < 5000; ++i) {
    const std::int64_t time_ns =
        clock.take(azimuth_at(i * kTrue_ns), kTurn_ns, kStart_utc_ns + i * kTrue_ns + delay_ns(random));
    if (i > 0) {
      EXPECT_NEAR(static_cast<double>(time_ns - before_ns), 384'000.0, 12'000.0) << i;
    }
    EXPECT_NEAR(static_cast<double>(time_ns), static_cast<double>(i * kTrue_ns), 400'000.0) << i;
    before_ns = time_ns;
  }
}

TEST(Hdl64S1Clock, CountsLostPacketsByHowFarTheRotorHasTurned) {
  Hdl64S1Clock clock;
  std::int64_t packet = 0;
  std::int64_t before_ns = 0;
  for (const std::int64_t step : {1, 1, 2, 1, 7, 1, 40, 1, 100, 1}) {
    const std::int64_t time_ns = clock.take(azimuth_at(packet * 384'000), kTurn_ns,
                                            kStart_utc_ns + packet * 384'000 + (packet % 3) * 100'000);
    EXPECT_NEAR(static_cast<double>(time_ns), static_cast<double>(packet) * 384'000.0, 30'000.0);
    EXPECT_GE(time_ns, before_ns);
    before_ns = time_ns;
    packet += step;
  }
}

TEST(Hdl64S1Clock, KnowsAPacketThatComesAgainOrLate) {
  Hdl64S1Clock clock;
  const auto take = [&clock](std::int64_t packet) {
    return clock.take(azimuth_at(packet * 384'000), kTurn_ns, kStart_utc_ns + packet * 384'000);
  };
  static_cast<void>(take(0));
  static_cast<void>(take(1));
  const std::int64_t third_ns = take(3);
  EXPECT_EQ(clock.take(azimuth_at(3 * 384'000), kTurn_ns, kStart_utc_ns + 3 * 384'000 + 90'000), third_ns);
  EXPECT_EQ(clock.take(azimuth_at(2 * 384'000), kTurn_ns, kStart_utc_ns + 3 * 384'000 + 95'000),
            third_ns - 384'000);
}

TEST(Hdl64S1Clock, StartsAnewAfterAPauseAndWithAnyReceiptAtAll) {
  Hdl64S1Clock clock;
  static_cast<void>(clock.take(0, kTurn_ns, kStart_utc_ns));
  EXPECT_EQ(clock.take(500, kTurn_ns, kStart_utc_ns + 5'000'000'000), 5'000'000'000);
  for (const std::int64_t utc_ns : {std::numeric_limits<std::int64_t>::min(),
                                    std::numeric_limits<std::int64_t>::max(), std::int64_t{0}}) {
    const std::int64_t time_ns = clock.take(35999, kTurn_ns, utc_ns);
    EXPECT_LT(std::abs(time_ns), 5'000'000'000'000'000'000);
  }
}

}  // namespace
}  // namespace landfix::drivers::velodyne
