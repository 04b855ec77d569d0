#include "platform/gnss.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "ndt/pose.hpp"
#include "platform/heap_counter.hpp"
#include "platform/map_projector_info.hpp"

namespace landfix::platform {
namespace {

constexpr std::int64_t kNow_utc_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr double kStep_deg = 1e-7;

VehicleSignal signal(VehicleRole role, std::uint32_t id, std::uint16_t start, double scale) {
  return {.role = role,
          .id = id,
          .field = {.start = start, .length = 32, .is_signed = true},
          .scale = scale,
          .low = -1e9,
          .high = 1e9,
          .timeout_ns = kSecond_ns};
}

/// Two frames: latitude and longitude; heading and altitude.
GnssSettings settings() {
  GnssSettings gnss;
  gnss.antenna_m = {1.0, 0.5, 1.5};
  gnss.signals[0] = signal(VehicleRole::latitude, 1, 0, kStep_deg * ndt::kRadians_per_deg);
  gnss.signals[1] = signal(VehicleRole::longitude, 1, 32, kStep_deg * ndt::kRadians_per_deg);
  gnss.signals[2] = signal(VehicleRole::heading, 2, 0, kStep_deg * ndt::kRadians_per_deg);
  gnss.signals[3] = signal(VehicleRole::altitude, 2, 32, 0.01);
  gnss.count = 4;
  return gnss;
}

CanFrame frame(std::uint32_t id, double first, double second) {
  CanFrame frame{.id = id, .length = 8, .data = {}};
  const auto put = [&frame](std::size_t at, double value) {
    const auto raw = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value)));
    for (std::size_t i = 0; i < 4; ++i) frame.data[at + i] = static_cast<std::byte>(raw >> 8 * i & 0xFFU);
  };
  put(0, first);
  put(4, second);
  return frame;
}

/// UTM, three degrees east of its central meridian: true north is 2.2 degrees left of the map's y.
class GnssGuess : public testing::Test {
 protected:
  void tell_position(std::int64_t stamp_utc_ns = kNow_utc_ns) {
    gnss_.add(frame(1, place_.latitude_deg / kStep_deg, place_.longitude_deg / kStep_deg), stamp_utc_ns);
  }
  void tell_heading(double heading_deg) {
    gnss_.add(frame(2, heading_deg / kStep_deg, place_.altitude_m / 0.01), kNow_utc_ns);
  }

  const MapReference reference_ = parse_map_projector_info(
      "projector_type: LocalCartesianUTM\nmap_origin: {latitude: 50.0, longitude: 11.9, altitude: 100.0}\n",
      "info.yaml");
  const Eigen::Vector3d antenna_m_{300.0, 200.0, 12.0};
  const GeodeticPosition place_ = to_geodetic(*reference_.projection, antenna_m_);
  Gnss gnss_{settings(), reference_.projection};
};

TEST_F(GnssGuess, IsTheVehicleNotTheAntenna) {
  EXPECT_FALSE(gnss_.guess(kNow_utc_ns));
  tell_position();
  tell_heading(90.0);
  const auto guess = gnss_.guess(kNow_utc_ns);
  ASSERT_TRUE(guess);
  // East in the map turns with its north, which is 2.2 deg to the left of y: sin(50 deg) times 2.9 deg.
  const double yaw_rad = *guess->yaw_rad;
  EXPECT_NEAR(yaw_rad / ndt::kRadians_per_deg, 2.22, 0.03);
  const Eigen::Vector2d lever_m(std::cos(yaw_rad) - 0.5 * std::sin(yaw_rad),
                                std::sin(yaw_rad) + 0.5 * std::cos(yaw_rad));
  EXPECT_LT((guess->position_m + lever_m - antenna_m_.head<2>()).norm(), 0.02);
  EXPECT_NEAR(*guess->height_m, 10.5, 0.01);
  EXPECT_EQ(guess->within_m, 3.0);
  EXPECT_EQ(gnss_.counters().frames, 2U);
  EXPECT_EQ(gnss_.counters().guesses, 1U);
}

TEST_F(GnssGuess, WithoutHeadingIsAsFarOffAsTheAntennaIsAway) {
  tell_position();
  const auto guess = gnss_.guess(kNow_utc_ns);
  ASSERT_TRUE(guess);
  EXPECT_FALSE(guess->yaw_rad);
  EXPECT_FALSE(guess->height_m);
  EXPECT_NEAR(guess->within_m, 3.0 + std::hypot(1.0, 0.5), 1e-9);
  EXPECT_LT((guess->position_m - antenna_m_.head<2>()).norm(), 0.02);
}

TEST_F(GnssGuess, IsForgottenInSilence) {
  tell_position();
  EXPECT_TRUE(gnss_.guess(kNow_utc_ns + kSecond_ns));
  EXPECT_FALSE(gnss_.guess(kNow_utc_ns + kSecond_ns + 1));
  EXPECT_FALSE(gnss_.guess(kNow_utc_ns - kSecond_ns)) << "the clock was set back";
}

TEST_F(GnssGuess, NeedsAProjection) {
  Gnss local(settings(), std::nullopt);
  local.add(frame(1, 5e8, 1e8), kNow_utc_ns);
  EXPECT_FALSE(local.guess(kNow_utc_ns));
}

TEST_F(GnssGuess, DoesNotTouchTheHeap) {
  if (!HeapCounter::available()) GTEST_SKIP() << "the heap is not counted here";
  const std::uint64_t before = HeapCounter::calls();
  HeapCounter::arm();
  for (int i = 0; i < 100; ++i) {
    tell_position();
    tell_heading(i);
    (void)gnss_.guess(kNow_utc_ns);
  }
  HeapCounter::disarm();
  EXPECT_EQ(HeapCounter::calls(), before);
}

}  // namespace
}  // namespace landfix::platform
