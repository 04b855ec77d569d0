#include "drivers/hesai/pandar64_decoder.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "drivers/civil_time.hpp"
#include "drivers/decoder_bench.hpp"
#include "support/synthetic_packets.hpp"

namespace landfix::drivers {
namespace {

using test::DecoderBench;
using test::Pandar64Packet;

constexpr std::uint8_t kStrongest = 0x37;
constexpr std::uint8_t kDual = 0x39;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;

const Beam& beam(std::size_t channel) { return find_sensor_model("pandar64")->beams[channel - 1]; }

RotorVector vector(const Point& point) { return {.x = point.x, .y = point.y, .z = point.z}; }

TEST(Pandar64Decoder, PointsABeamWhereTheManualSays) {
  DecoderBench bench("pandar64", {.optical_centre = false});
  Pandar64Packet packet;
  packet.set_azimuths(10000, 20);
  packet.set_return(0, 20, 2500, 200);  // channel 21
  ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 1U);
  const Point& point = bench.points()[0];
  const double azimuth_rad =
      (100.0 + beam(21).azimuth_offset_deg + 3600.0 * beam(21).firing_time_us * 1e-6) * kRadPerDeg;
  const double elevation_rad = beam(21).elevation_deg * kRadPerDeg;
  EXPECT_NEAR(point.x, 10.0 * std::cos(elevation_rad) * std::cos(azimuth_rad), 5e-6);
  EXPECT_NEAR(point.y, -10.0 * std::cos(elevation_rad) * std::sin(azimuth_rad), 5e-6);
  EXPECT_NEAR(point.z, 10.0 * std::sin(elevation_rad), 5e-6);
  EXPECT_EQ(point.ring, beam(21).ring);
  EXPECT_EQ(point.intensity, 200.0F);
}

TEST(Pandar64Decoder, LeavesTheFiringTimeOutOfTheAzimuthWhenAskedTo) {
  DecoderBench bench("pandar64", {.firing_time_azimuth = false, .optical_centre = false});
  Pandar64Packet packet;
  packet.set_azimuths(10000, 20);
  packet.set_return(0, 20, 2500);
  static_cast<void>(bench.decode(packet.bytes()));
  ASSERT_EQ(bench.points().size(), 1U);
  const Point& point = bench.points()[0];
  EXPECT_NEAR(std::atan2(-vector(point).y, vector(point).x) / kRadPerDeg, 100.0 + beam(21).azimuth_offset_deg,
              1e-5);
}

TEST(Pandar64Decoder, MeasuresTheRangeFromTheCentreAndStartsTheBeamBesideIt) {
  constexpr double kRangeM = 2.0;
  constexpr double kForwardM = 0.03873;
  constexpr double kLeftM = 0.012;
  DecoderBench plain("pandar64", {.optical_centre = false});
  DecoderBench centred("pandar64");
  Pandar64Packet packet;
  packet.set_azimuths(0, 20);
  for (std::size_t slot = 0; slot < 64; ++slot)
    packet.set_return(0, slot, static_cast<unsigned>(kRangeM / 0.004));
  static_cast<void>(plain.decode(packet.bytes()));
  static_cast<void>(centred.decode(packet.bytes()));
  ASSERT_EQ(centred.points().size(), 64U);
  for (std::size_t i = 0; i < 64; ++i) {
    const RotorVector beside = vector(centred.points()[i]);
    EXPECT_NEAR(std::hypot(beside.x, beside.y, beside.z), kRangeM, 2e-6);
    // The point lies on the beam from the optical centre, at this distance from it.
    const RotorVector from_centre = vector(plain.points()[i]);
    const double cosine = (kForwardM * from_centre.x + kLeftM * from_centre.y) / (kRangeM * kRangeM);
    const double ahead_m = kRangeM * cosine;
    const double along_m =
        std::sqrt(ahead_m * ahead_m - kForwardM * kForwardM - kLeftM * kLeftM + kRangeM * kRangeM) - ahead_m;
    // The optical centre turns with the rotor, by up to 0.2 deg since the block's azimuth.
    EXPECT_NEAR(beside.x - from_centre.x * along_m / kRangeM, kForwardM, 2e-4);
    EXPECT_NEAR(beside.y - from_centre.y * along_m / kRangeM, kLeftM, 2e-4);
    EXPECT_NEAR(beside.z - from_centre.z * along_m / kRangeM, 0.0, 1e-5);
  }
}

TEST(Pandar64Decoder, DatesEachFiringBackFromThePacketsEnd) {
  for (const std::uint8_t mode : {kStrongest, kDual}) {
    const std::size_t returns = mode == kDual ? 2 : 1;
    DecoderBench bench("pandar64");
    Pandar64Packet packet(mode);
    packet.set_azimuths(10000, 20, returns);
    packet.set_microseconds(500'000);
    packet.set_return(0, 0, 1000);
    packet.set_return(5, 63, 1000);
    const std::int64_t packed_utc_ns = Pandar64Packet::kDateUtcNs + 500'000'000;
    ASSERT_EQ(bench.decode(packet.bytes(), packed_utc_ns + 1'000'000).status, DecodeStatus::decoded);
    ASSERT_TRUE(bench.flush());
    const auto& sweep = bench.swept().at(0);
    EXPECT_EQ(sweep.time_source, TimeSource::sensor);
    ASSERT_EQ(sweep.points.size(), 2U);
    const double start_us = static_cast<double>(sweep.start_utc_ns - packed_utc_ns) * 1e-3;
    EXPECT_NEAR(start_us, returns == 2 ? -208.368 : -375.048, 0.001) << "the earliest firing";
    const double before_us = static_cast<double>(6 / returns - 1) * 55.56;
    EXPECT_NEAR(start_us + static_cast<double>(sweep.points[0].time_s) * 1e6,
                -42.58 - before_us + beam(1).firing_time_us, 0.01);
    EXPECT_NEAR(start_us + static_cast<double>(sweep.points[1].time_s) * 1e6,
                -42.58 + beam(64).firing_time_us, 0.01);
  }
}

TEST(Pandar64Decoder, TakesTheCountsFromTheHeader) {
  DecoderBench bench("pandar64");
  Pandar64Packet seven(kStrongest, 7);
  seven.set_azimuths(10000, 20);
  seven.set_return(6, 0, 1000);
  EXPECT_EQ(bench.decode(seven.bytes()).status, DecodeStatus::decoded);
  Pandar64Packet counted(kStrongest, 7, 1);
  counted.set_azimuths(10140, 20);
  counted.set_microseconds(389);
  EXPECT_EQ(bench.decode(counted.bytes()).status, DecodeStatus::decoded);
  EXPECT_EQ(bench.all_points().size(), 1U);
  Pandar64Packet unit;
  unit.set_azimuths(10280, 20);
  unit.set_microseconds(778);
  unit.set_byte(5, 8);
  unit.set_return(0, 0, 1000);
  EXPECT_EQ(bench.decode(unit.bytes()).status, DecodeStatus::decoded);
  const Point point = bench.all_points().back();
  EXPECT_NEAR(std::hypot(point.x, point.y, point.z), 8.0, 1e-5);
}

TEST(Pandar64Decoder, RefusesAPacketThatIsNotWhatItShouldBe) {
  DecoderBench bench("pandar64");
  const auto status = [&](auto change) {
    Pandar64Packet packet;
    packet.set_azimuths(1000, 20);
    packet.set_return(0, 0, 1000);
    change(packet);
    return bench.decode(packet.bytes()).status;
  };
  EXPECT_EQ(status([](auto& p) { p.set_byte(0, 0xEF); }), DecodeStatus::wrong_header);
  EXPECT_EQ(status([](auto& p) { p.set_byte(2, 40); }), DecodeStatus::wrong_model);
  EXPECT_EQ(status([](auto& p) { p.set_byte(3, 5); }), DecodeStatus::wrong_header);
  EXPECT_EQ(status([](auto& p) { p.set_byte(3, 7); }), DecodeStatus::wrong_size);
  EXPECT_EQ(status([](auto& p) { p.set_byte(5, 0); }), DecodeStatus::wrong_header);
  EXPECT_EQ(status([](auto& p) { p.set_mode(0x3B); }), DecodeStatus::wrong_return_mode);
  EXPECT_EQ(status([](auto& p) { p.set_rpm(65535); }), DecodeStatus::wrong_header);
  EXPECT_EQ(status([](auto& p) { p.set_microseconds(1'000'001); }), DecodeStatus::wrong_time);
  EXPECT_EQ(status([](auto& p) { p.set_date({21, 2, 29, 0, 0, 0}); }), DecodeStatus::wrong_time);
  EXPECT_EQ(status([](auto& p) { p.set_date({255, 1, 1, 0, 0, 0}); }), DecodeStatus::wrong_time);
  EXPECT_EQ(status([](auto& p) { p.set_date({21, 0, 1, 0, 0, 0}); }), DecodeStatus::wrong_time);
  EXPECT_EQ(status([](auto& p) { p.set_date({21, 1, 1, 24, 0, 0}); }), DecodeStatus::wrong_time);
  EXPECT_EQ(status([](auto& p) { p.set_azimuth(5, 36000); }), DecodeStatus::wrong_azimuth);
  EXPECT_EQ(status([](auto& p) { p.set_azimuths(0, 17000); }), DecodeStatus::wrong_azimuth);
  EXPECT_EQ(status([](auto& p) { p.set_mode(kDual); }), DecodeStatus::wrong_azimuth) << "pairs differ";
  Pandar64Packet odd(kDual, 7);
  EXPECT_EQ(bench.decode(odd.bytes()).status, DecodeStatus::wrong_header) << "seven blocks are no pairs";
  EXPECT_TRUE(bench.all_points().empty());
}

TEST(Pandar64Decoder, CountsYearsFrom2000OrFrom1900) {
  for (const auto& [year, expected] : {std::pair{17U, 2017}, {99U, 2099}, {117U, 2017}, {120U, 2020}}) {
    DecoderBench bench("pandar64");
    Pandar64Packet packet;
    packet.set_azimuths(1000, 20);
    packet.set_date({year, 3, 1, 0, 0, 0});
    packet.set_return(0, 0, 1000);
    const std::int64_t utc_ns = *unix_seconds({.year = expected, .month = 3, .day = 1}) * 1'000'000'000;
    ASSERT_EQ(bench.decode(packet.bytes(), utc_ns).status, DecodeStatus::decoded);
    ASSERT_TRUE(bench.flush());
    EXPECT_EQ(bench.swept().at(0).time_source, TimeSource::sensor) << year;
  }
}

TEST(CivilTime, KnowsTheCalendar) {
  EXPECT_EQ(unix_seconds({.year = 2000, .month = 1, .day = 1}), 946'684'800);
  EXPECT_EQ(unix_seconds({.year = 2024, .month = 12, .day = 31, .hour = 23, .minute = 59, .second = 59}),
            1'735'689'599);
  EXPECT_EQ(unix_seconds({.year = 2024, .month = 2, .day = 29}), 1'709'164'800);
  EXPECT_FALSE(unix_seconds({.year = 2023, .month = 2, .day = 29}).has_value());
  EXPECT_FALSE(unix_seconds({.year = 2023, .month = 4, .day = 31}).has_value());
  EXPECT_FALSE(unix_seconds({.year = 2023, .month = 13, .day = 1}).has_value());
  EXPECT_FALSE(unix_seconds({.year = 1999, .month = 12, .day = 31}).has_value());
}

}  // namespace
}  // namespace landfix::drivers
