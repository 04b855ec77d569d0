// How fast a rotor turns and how long a firing slot lasts, from what the packets show of them.
#include <array>
#include <numbers>

#include <gtest/gtest.h>

#include "drivers/robosense/rotation.hpp"
#include "drivers/velodyne/slot_time.hpp"
#include "drivers/velodyne/spin_rate.hpp"

namespace landfix::drivers {
namespace {

constexpr double kRadPerCentideg = 0.01 * std::numbers::pi / 180.0;

/// [0.01 deg/us] after many packets with blocks at these azimuths, 50 us apart; 0.36 is 600 rpm.
double spin_rate(std::initializer_list<std::uint16_t> azimuths_centideg) {
  velodyne::SpinRate rate;
  for (int i = 0; i < 1000; ++i)
    rate.update(std::span(azimuths_centideg.begin(), azimuths_centideg.size()), 50.0);
  return rate.rad_per_s() / kRadPerCentideg * 1e-6;
}

TEST(SpinRate, Is600RpmUntilAPacketSaysOtherwise) {
  const velodyne::SpinRate rate;
  EXPECT_NEAR(rate.rad_per_s(), 20.0 * std::numbers::pi, 1e-9);
  EXPECT_EQ(rate.turn_ns(), 100'000'000);
}

TEST(SpinRate, IsTheMeanOfTheStepsAlsoThroughZero) {
  EXPECT_NEAR(spin_rate({100, 109, 119, 128}), 28.0 / 150.0, 1e-9);
  EXPECT_NEAR(spin_rate({35990, 35999, 9, 18}), 28.0 / 150.0, 1e-9);
}

TEST(SpinRate, LeavesOutASectorThatIsLeftOutAndAStepBack) {
  EXPECT_NEAR(spin_rate({100, 110, 18000, 18010, 18020}), 0.2, 1e-9);
  EXPECT_NEAR(spin_rate({100, 110, 105, 115, 125}), 0.2, 1e-9);
}

TEST(SpinRate, IsNotMovedByWhatNoRotorDoes) {
  EXPECT_EQ(spin_rate({}), spin_rate({100})) << "too few";
  EXPECT_NEAR(spin_rate({100, 100, 100}), 0.36, 1e-9) << "stands still";
  EXPECT_NEAR(spin_rate({0, 9000, 18000, 27000}), 0.36, 1e-9) << "too fast";
}

TEST(SpinRate, FollowsASixteenthOfTheWayAPacket) {
  velodyne::SpinRate rate;
  rate.update(std::array<std::uint16_t, 3>{0, 34, 68}, 50.0);
  EXPECT_NEAR(rate.rad_per_s() / kRadPerCentideg * 1e-6, 0.36 + (0.68 - 0.36) / 16.0, 1e-9);
}

TEST(SpinRate, KnowsWhenTheRotorGetsBehindASectorThatIsLeftOut) {
  const velodyne::SpinRate rate;
  EXPECT_EQ(rate.time_between(100, 120, 55'296), 55'296);
  EXPECT_EQ(rate.time_between(100, 95, 55'296), 55'296) << "a step back";
  EXPECT_EQ(rate.time_between(9000, 27000, 55'296), 50'000'000) << "half a turn";
}

TEST(SlotTime, IsTheManualsUntilPacketsTell) { EXPECT_EQ(velodyne::SlotTime().us(), 2.665); }

TEST(SlotTime, AveragesStampsThatAreWholeMicroseconds) {
  velodyne::SlotTime slot;
  for (int i = 0; i < 1000; ++i) slot.update(i % 5 == 0 ? 165'000 : 166'000, 60);  // 165.8 us
  EXPECT_NEAR(slot.us(), 165.8 / 60.0, 1e-4);
}

TEST(SlotTime, TakesTheFirstPacketAtItsWordAndLeavesGapsOut) {
  velodyne::SlotTime slot;
  slot.update(55'600, 20);
  EXPECT_NEAR(slot.us(), 2.78, 1e-12);
  for (const std::int64_t spacing_ns : {0, -55'600, 111'200, 47'000}) slot.update(spacing_ns, 20);
  EXPECT_NEAR(slot.us(), 2.78, 1e-12);
}

TEST(MeanStep, LeavesGapsOut) {
  using robosense::mean_step_centideg;
  EXPECT_EQ(mean_step_centideg(std::array<std::uint16_t, 4>{35980, 0, 20, 41}), 61.0 / 3.0);
  EXPECT_EQ(mean_step_centideg(std::array<std::uint16_t, 4>{100, 120, 9000, 9020}), 20.0);
  EXPECT_EQ(mean_step_centideg(std::array<std::uint16_t, 2>{100, 9000}), 0.0) << "nothing but a gap";
  EXPECT_EQ(mean_step_centideg(std::array<std::uint16_t, 1>{100}), 0.0);
  EXPECT_EQ(mean_step_centideg({}), 0.0);
}

TEST(RotorSpeed, IsWhatTheSensorIsSetToUntilItIsMeasured) {
  robosense::RotorSpeed speed;
  EXPECT_NEAR(speed.centideg_per_us(), 0.36, 1e-12);
  speed.set_nominal(1200);
  EXPECT_NEAR(speed.centideg_per_us(), 0.72, 1e-12);
  speed.set_nominal(0);
  EXPECT_NEAR(speed.centideg_per_us(), 0.36, 1e-12) << "not known";
  speed.update(100, 1'000'000);
  speed.update(280, 2'000'000);
  EXPECT_NEAR(speed.centideg_per_us(), 0.18, 1e-12) << "the first measurement counts whole";
  speed.set_nominal(1200);
  EXPECT_NEAR(speed.centideg_per_us(), 0.18, 1e-12) << "measured is better";
  speed.update(640, 3'000'000);
  EXPECT_NEAR(speed.centideg_per_us(), 0.18 + 0.18 / 16.0, 1e-12) << "the next ones a sixteenth";
}

TEST(RotorSpeed, IsNotMovedByWhatNoRotorDoes) {
  robosense::RotorSpeed speed;
  speed.update(100, 1'000'000);
  speed.update(100, 2'000'000);     // stands still
  speed.update(20100, 3'000'000);   // too fast
  speed.update(20460, 3'000'000);   // in no time
  speed.update(20820, 2'000'000);   // back in time
  speed.update(24000, 20'000'000);  // it may have turned more than once
  EXPECT_NEAR(speed.centideg_per_us(), 0.36, 1e-12);
  speed.set_nominal(300);
  EXPECT_NEAR(speed.centideg_per_us(), 0.18, 1e-12) << "it has not been measured yet";
}

}  // namespace
}  // namespace landfix::drivers
