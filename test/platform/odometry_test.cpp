#include "platform/odometry.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "platform/nanoseconds.hpp"

namespace landfix::platform {
namespace {

constexpr std::int64_t kStart = 1'700'000'000'000 * kNs_per_ms;

OdometrySettings settings_of(bool has_reverse = false) {
  OdometrySettings settings;
  settings.signals[0] = {.role = VehicleRole::speed,
                         .id = 0x10,
                         .field = {.start = 0, .length = 16, .is_signed = true},
                         .scale = 0.01,
                         .low = -100.0,
                         .high = 100.0,
                         .timeout_ns = 200 * kNs_per_ms};
  settings.signals[1] = {.role = VehicleRole::yaw_rate,
                         .id = 0x11,
                         .field = {.start = 0, .length = 16, .is_signed = true},
                         .scale = 0.0001,
                         .low = -3.0,
                         .high = 3.0,
                         .timeout_ns = 200 * kNs_per_ms};
  settings.signals[2] = {.role = VehicleRole::reverse,
                         .id = 0x12,
                         .field = {.start = 0, .length = 1},
                         .low = 0.0,
                         .high = 1.0,
                         .timeout_ns = 1000 * kNs_per_ms};
  settings.count = has_reverse ? 3 : 2;
  return settings;
}

CanFrame frame_of(std::uint32_t id, double steps) {
  const auto raw = static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(steps)));
  CanFrame frame{.id = id, .length = 8, .data = {}};
  frame.data[0] = static_cast<std::byte>(raw & 0xFF);
  frame.data[1] = static_cast<std::byte>(raw >> 8);
  return frame;
}

/// A vehicle that drives at 10 m/s and 0.2 rad/s, tracked at 10 Hz; its odometry says what `says` makes of
/// that.
class Drive : public testing::Test {
 protected:
  using Says = std::function<double(double truth, double time_s)>;

  void drive(double seconds, const Says& speed_says, bool is_tracked = true) {
    const int steps = static_cast<int>(std::lround(seconds * 100.0));
    for (int i = 0; i < steps; ++i) {
      now_ += 10 * kNs_per_ms;
      const double time_s = static_cast<double>(now_ - kStart) * 1e-9;
      const double speed = speed_says(10.0, time_s);
      if (!std::isnan(speed)) odometry_.add(frame_of(0x10, speed / 0.01), now_);
      odometry_.add(frame_of(0x11, 0.2 / 0.0001), now_);
      if (is_tracked && (now_ - kStart) % (100 * kNs_per_ms) == 0)
        odometry_.compare(now_ - 100 * kNs_per_ms, now_, truth_);
    }
  }
  [[nodiscard]] std::optional<ndt::MeasuredMotion> last_second() const {
    return odometry_.motion(now_ - 1000 * kNs_per_ms, now_, otherwise_);
  }

  static constexpr auto kTrue = [](double truth, double /*time_s*/) { return truth; };
  static constexpr auto kDouble = [](double truth, double /*time_s*/) { return 2.0 * truth; };
  static constexpr auto kStuck = [](double /*truth*/, double /*time_s*/) { return 3.0; };
  static constexpr auto kSilent = [](double /*truth*/, double /*time_s*/) { return std::nan(""); };

  ndt::Velocity truth_ = (ndt::Velocity() << 10.0, 0.0, 0.0, 0.0, 0.0, 0.2).finished();
  ndt::Velocity otherwise_ = (ndt::Velocity() << 7.0, 0.1, 0.0, 0.0, 0.0, 0.1).finished();
  std::int64_t now_ = kStart;
  Odometry odometry_{settings_of()};
};

TEST_F(Drive, IsBelievedOnceItHasAgreed) {
  drive(0.5, kTrue);
  EXPECT_FALSE(last_second());
  drive(1.5, kTrue);
  const auto motion = last_second();
  ASSERT_TRUE(motion);
  // An arc: radius 50 m, 0.2 rad.
  EXPECT_NEAR(motion->change.translation().x(), 50.0 * std::sin(0.2), 1e-3);
  EXPECT_NEAR(motion->change.translation().y(), 50.0 * (1.0 - std::cos(0.2)), 1e-3);
  EXPECT_NEAR(motion->velocity[0], 10.0, 1e-9);
  EXPECT_NEAR(motion->velocity[5], 0.2, 1e-9);
  ASSERT_TRUE(motion->sigma_mps);
  EXPECT_NEAR(*motion->sigma_mps, 0.05, 0.01);
  EXPECT_EQ(odometry_.counters().samples, 400U);
  EXPECT_EQ(odometry_.counters().jumps, 0U);
}

TEST_F(Drive, FollowsWhatChangesBetweenTwoTimes) {
  drive(3.0, kTrue);
  drive(
      1.0, [](double truth, double time_s) { return truth - 4.0 * (time_s - 3.0); }, false);
  const auto motion = last_second();
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->velocity[0], 6.0, 0.01);
  EXPECT_NEAR(motion->change.translation().norm(), 8.0, 0.03);
}

TEST_F(Drive, AWrongScaleIsLeftOutFromTheStartAndOnTheWay) {
  drive(5.0, kDouble);
  EXPECT_FALSE(odometry_.speed().is_believed());
  EXPECT_TRUE(odometry_.yaw_rate().is_believed());
  const auto motion = last_second();
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->velocity[0], 7.0);
  EXPECT_NEAR(motion->velocity[5], 0.2, 1e-9);
  EXPECT_FALSE(motion->sigma_mps);

  drive(5.0, kTrue);
  EXPECT_TRUE(odometry_.speed().is_believed());
  drive(1.0, kDouble);
  EXPECT_FALSE(odometry_.speed().is_believed());
  EXPECT_EQ(odometry_.counters().times_left_out, 1U);
  drive(5.0, kTrue);
  EXPECT_TRUE(odometry_.speed().is_believed()) << "taken back";
}

TEST_F(Drive, AScaleThatIsAFewPercentWrongIsBelievedAndSaidToBeWorseThanARightOne) {
  drive(5.0, [](double truth, double /*time_s*/) { return 1.02 * truth; });
  ASSERT_TRUE(last_second());
  EXPECT_NEAR(*last_second()->sigma_mps, 0.2, 0.03);
}

TEST_F(Drive, AStuckValueIsLeftOut) {
  drive(3.0, kTrue);
  drive(2.0, kStuck);
  EXPECT_FALSE(odometry_.speed().is_believed());
}

TEST_F(Drive, SilenceIsLeftOutAfterItsTimeOut) {
  drive(3.0, kTrue);
  drive(0.15, kSilent, false);
  EXPECT_TRUE(odometry_.motion(now_ - 100 * kNs_per_ms, now_, otherwise_)->sigma_mps);
  drive(0.85, kSilent);
  const auto motion = odometry_.motion(now_ - 100 * kNs_per_ms, now_, otherwise_);
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->velocity[0], 7.0);
  EXPECT_FALSE(motion->sigma_mps);
  EXPECT_GT(odometry_.counters().silent, 5U);
  drive(1.0, kTrue);
  EXPECT_FALSE(odometry_.motion(now_ - 1500 * kNs_per_ms, now_, otherwise_)->sigma_mps) << "over the silence";
  EXPECT_TRUE(odometry_.motion(now_ - 100 * kNs_per_ms, now_, otherwise_)->sigma_mps);
}

TEST_F(Drive, AJumpIsLeftOut) {
  drive(3.0, kTrue);
  drive(1.0, [](double truth, double time_s) {
    return static_cast<int>(std::lround(time_s * 100.0)) % 10 == 0 ? truth + 30.0 : truth;
  });
  EXPECT_EQ(odometry_.counters().jumps, 10U);
  ASSERT_TRUE(last_second());
  EXPECT_NEAR(last_second()->change.translation().norm(), 10.0, 0.1);
}

TEST_F(Drive, AtStandstillItKnowsThatNothingMoves) {
  truth_.setZero();
  for (int i = 0; i < 300; ++i) {
    now_ += 10 * kNs_per_ms;
    odometry_.add(frame_of(0x10, 0), now_);
    odometry_.add(frame_of(0x11, 0), now_);
    if (i % 10 == 9) odometry_.compare(now_ - 100 * kNs_per_ms, now_, truth_);
  }
  ASSERT_TRUE(last_second());
  EXPECT_EQ(last_second()->change.translation().norm(), 0.0);
}

TEST(Odometry, TheReverseGearTurnsTheSpeedAround) {
  Odometry odometry(settings_of(true));
  odometry.add(frame_of(0x10, 500), kStart);
  EXPECT_EQ(odometry.counters().invalid, 1U) << "forwards or backwards?";
  odometry.add(frame_of(0x12, 1), kStart + 10 * kNs_per_ms);
  odometry.add(frame_of(0x10, 500), kStart + 20 * kNs_per_ms);
  EXPECT_EQ(odometry.speed().at(kStart + 25 * kNs_per_ms), -5.0);
  odometry.add(frame_of(0x10, 500), kStart + 1500 * kNs_per_ms);
  EXPECT_EQ(odometry.counters().invalid, 2U) << "the gear has fallen silent";
}

TEST(Odometry, FourWheelsGiveSpeedAndYawRate) {
  OdometrySettings settings;
  settings.track_m = 1.6;
  settings.count = 4;
  for (std::uint16_t i = 0; i < 4; ++i) {
    settings.signals[i] = {.role = static_cast<VehicleRole>(static_cast<int>(VehicleRole::wheel_fl) + i),
                           .id = 0x20,
                           .field = {.start = static_cast<std::uint16_t>(16 * i), .length = 16},
                           .scale = 0.01,
                           .low = 0.0,
                           .high = 100.0,
                           .timeout_ns = 200 * kNs_per_ms};
  }
  Odometry odometry(settings);
  CanFrame frame{.id = 0x20, .length = 8, .data = {}};
  const std::array<int, 4> wheels{0x0190, 0x0190, 484, 516};  // the rear ones: 4.84 and 5.16 m/s
  for (std::size_t i = 0; i < 4; ++i) {
    frame.data[2 * i] = static_cast<std::byte>(wheels.at(i) & 0xFF);
    frame.data[2 * i + 1] = static_cast<std::byte>(wheels.at(i) >> 8);
  }
  odometry.add(frame, kStart);
  EXPECT_NEAR(odometry.speed().at(kStart).value(), 5.0, 1e-9);
  EXPECT_NEAR(odometry.yaw_rate().at(kStart).value(), 0.2, 1e-9);
}

TEST(Odometry, FramesOfOthersAndAnyTimesDoNoHarm) {
  Odometry odometry(settings_of());
  odometry.add(frame_of(0x7FF, 1), kStart);
  EXPECT_EQ(odometry.counters().frames, 0U);
  odometry.add(frame_of(0x10, 100), kStart);
  odometry.add(frame_of(0x10, 100), kStart);  // out of order
  EXPECT_EQ(odometry.counters().jumps, 1U);
  odometry.add(frame_of(0x10, 900), kStart - 3'600'000 * kNs_per_ms);  // a clock set back: begins anew
  EXPECT_EQ(odometry.speed().at(kStart - 3'600'000 * kNs_per_ms), 9.0);
  EXPECT_FALSE(odometry.motion(kStart, kStart - 1, ndt::Velocity::Zero()));
  EXPECT_FALSE(odometry.motion(0, kStart, ndt::Velocity::Zero()));
}

}  // namespace
}  // namespace landfix::platform
