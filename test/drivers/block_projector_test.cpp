#include "drivers/block_projector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace landfix::drivers {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kTurnRate_rad_per_s = 20.0 * std::numbers::pi;  // 600 rpm

TEST(RangeGate, KeepsRangesOnItsBounds) {
  // 0.3 and 0.6 are no multiples of 0.002 in binary.
  const RangeGate gate(0.002, 0.3, 0.6);
  EXPECT_TRUE(gate.admits(150));
  EXPECT_TRUE(gate.admits(300));
  EXPECT_FALSE(gate.admits(149));
  EXPECT_FALSE(gate.admits(301));
}

TEST(RangeGate, KeepsWhatIsBetweenTwoUnitsOut) {
  const RangeGate gate(0.004, 0.009, 0.015);
  EXPECT_FALSE(gate.admits(2));
  EXPECT_TRUE(gate.admits(3));
  EXPECT_FALSE(gate.admits(4));
}

TEST(RangeGate, NeverTakesZeroForAReturn) {
  const RangeGate open(0.002, 0.0, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(open.admits(0));
  EXPECT_TRUE(open.admits(1));
  EXPECT_TRUE(open.admits(65535));
  EXPECT_FALSE(RangeGate().admits(0));
}

TEST(RangeGate, BeyondTheWireKeepsNothing) {
  const RangeGate gate(0.002, 0.0, 0.001);
  EXPECT_FALSE(gate.admits(0));
  EXPECT_FALSE(gate.admits(1));
  EXPECT_FALSE(gate.admits(65535));
}

/// Slots of the wire: range u16, intensity u8.
using Slots = std::array<std::byte, 2 * kSlotBytes>;

/// Two returns of 10 m, at 2 mm a unit.
constexpr Slots kTenMetres{std::byte{0x88}, std::byte{0x13}, std::byte{7},
                           std::byte{0x88}, std::byte{0x13}, std::byte{8}};

std::vector<Point> project(const BlockProjector& projector, std::uint16_t azimuth_centideg,
                           std::size_t room = 2) {
  std::vector<Point> storage(room);
  Sweep sweep(storage);
  sweep.begin(0, true, TimeSource::sensor);
  projector.project(
      {.slots = kTenMetres.data(), .azimuth_centideg = azimuth_centideg, .time_s = 0.5F, .unit_m = 0.002F},
      RangeGate(0.002, 0.0, 100.0), sweep);
  EXPECT_EQ(sweep.overflowed(), 2 - std::min<std::size_t>(room, 2));
  return {sweep.points().begin(), sweep.points().end()};
}

void expect_at(const Point& point, double azimuth_deg, double elevation_deg, const char* what) {
  const double flat_m = 10.0 * std::cos(elevation_deg * kRadPerDeg);
  EXPECT_NEAR(point.x, flat_m * std::cos(azimuth_deg * kRadPerDeg), 2e-6) << what;
  EXPECT_NEAR(point.y, -flat_m * std::sin(azimuth_deg * kRadPerDeg), 2e-6) << what;
  EXPECT_NEAR(point.z, 10.0 * std::sin(elevation_deg * kRadPerDeg), 2e-6) << what;
}

TEST(BlockProjector, AddsAzimuthAndOffsetClockwiseAndElevationUpwards) {
  const std::array<FiringSlot, 2> slots{
      {{.elevation_deg = 15.0, .time_s = 2e-6, .ring = 1},
       {.elevation_deg = -25.0, .azimuth_offset_deg = 4.2, .time_s = 4e-6, .ring = 0}}};
  const auto points = project(BlockProjector(slots, RangeFrom::beam_origin), 9000);
  ASSERT_EQ(points.size(), 2U);
  expect_at(points[0], 90.0, 15.0, "to the right, up");
  expect_at(points[1], 94.2, -25.0, "to the right and a little back, down");
  EXPECT_EQ(points[0].intensity, 7.0F);
  EXPECT_EQ(points[1].ring, 0U);
  EXPECT_NEAR(points[1].time_s, 0.500004, 1e-7);
}

TEST(BlockProjector, TurnsEachBeamOnByItsOwnFiringTime) {
  const std::array<FiringSlot, 2> slots{{{.turning_time_s = 0.0}, {.turning_time_s = 50e-6}}};
  BlockProjector projector(slots, RangeFrom::beam_origin);
  projector.set_turn_rate(kTurnRate_rad_per_s);
  auto points = project(projector, 35990);
  expect_at(points[0], 359.9, 0.0, "at the azimuth of the block");
  expect_at(points[1], 0.08, 0.0, "3600 deg/s for 50 us");
  projector.set_turn_rate(0.0);
  points = project(projector, 35990);
  expect_at(points[1], 359.9, 0.0, "at rest");
}

TEST(BlockProjector, DoesNotTurnForLessThanATenthOfTheWiresUnit) {
  const std::array<FiringSlot, 2> slots{{{.turning_time_s = 0.0}, {.turning_time_s = 50e-6}}};
  BlockProjector projector(slots, RangeFrom::beam_origin);
  projector.set_turn_rate(0.9 * kLeastTurnRad / 50e-6);
  expect_at(project(projector, 0)[1], 0.0, 0.0, "too little");
  projector.set_turn_rate(1.1 * kLeastTurnRad / 50e-6);
  expect_at(project(projector, 0)[1], 0.0011, 0.0, "enough");
}

TEST(BlockProjector, MeasuresFromTheBeamsOriginOrFromTheCentre) {
  const std::array<FiringSlot, 1> slots{
      {{.elevation_deg = 10.0, .origin_m = {.x = 0.04, .y = 0.01, .z = 0.02}}}};
  const auto distance = [](const Point& point, float x, float y, float z) {
    return std::hypot(point.x - x, point.y - y, point.z - z);
  };
  const Point from_origin = project(BlockProjector(slots, RangeFrom::beam_origin), 0)[0];
  EXPECT_NEAR(distance(from_origin, 0.04F, 0.01F, 0.02F), 10.0F, 2e-6);
  const Point from_centre = project(BlockProjector(slots, RangeFrom::sensor_centre), 0)[0];
  EXPECT_NEAR(distance(from_centre, 0.0F, 0.0F, 0.0F), 10.0F, 2e-6);
  EXPECT_NEAR(from_centre.y, 0.01, 1e-6) << "still on the beam";
}

TEST(BlockProjector, FillsTheRoomThereIsAndCountsTheRest) {
  const std::array<FiringSlot, 2> slots{{{.ring = 3}, {.ring = 4}}};
  const BlockProjector projector(slots, RangeFrom::beam_origin);
  EXPECT_EQ(project(projector, 0, 0).size(), 0U);
  const auto points = project(projector, 0, 1);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(points[0].ring, 3U);
}

}  // namespace
}  // namespace landfix::drivers
