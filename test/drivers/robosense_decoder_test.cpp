// Rules of the family: calibration in the stream, returns, timing, azimuths, soundness.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "drivers/robosense/decoder.hpp"
#include "support/decoder_bench.hpp"
#include "support/robosense_packets.hpp"

namespace landfix::drivers {
namespace {

using test::DecoderBench;
using test::RobosenseDeviceInfo;
using test::RobosensePacket;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr std::int64_t kReceivedNs = RobosensePacket::kTimeUtcNs + 1'000'000;

double range_of(const Point& point) {
  return std::hypot(static_cast<double>(point.x), static_cast<double>(point.y), static_cast<double>(point.z));
}
double azimuth_deg(const Point& point) {
  return std::fmod(
      360.0 - std::atan2(static_cast<double>(point.y), static_cast<double>(point.x)) * kDegPerRad, 360.0);
}
double elevation_deg(const Point& point) {
  return std::atan2(static_cast<double>(point.z),
                    std::hypot(static_cast<double>(point.x), static_cast<double>(point.y))) *
         kDegPerRad;
}

/// A decoder that has had the unit's device information, without the lens beside the axis.
DecoderBench bench_of(const char* model, DecoderOptions options = {.optical_centre = false}) {
  DecoderBench bench(model, options);
  EXPECT_EQ(bench.decode(test::robosense_unit(model).bytes(), kReceivedNs).status, DecodeStatus::telemetry);
  return bench;
}

TEST(RobosenseDecoder, RefusesPointsUntilTheUnitHasSaidItsAngles) {
  DecoderBench bench("rs32");
  RobosensePacket packet;
  packet.set_azimuths(1000, 20);
  packet.set_return(0, 0, 1000);
  EXPECT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::uncalibrated);
  EXPECT_EQ(bench.decode(RobosenseDeviceInfo().bytes()).status, DecodeStatus::telemetry) << "not programmed";
  EXPECT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::uncalibrated);
  EXPECT_EQ(bench.decode(test::robosense_unit("helios16p").bytes()).status, DecodeStatus::wrong_model);
  EXPECT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::wrong_model);
  packet.set_byte(1246, 1);
  EXPECT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::wrong_header) << "sound first";
  packet.set_byte(1246, 0);
  EXPECT_EQ(bench.decode(test::robosense_unit("rs32").bytes()).status, DecodeStatus::telemetry);
  EXPECT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  EXPECT_EQ(bench.points().size(), 1U);
}

TEST(RobosenseDecoder, TakesAnglesThatChange) {
  DecoderBench bench = bench_of("rs32");
  RobosenseDeviceInfo replaced = test::robosense_unit("rs32");
  replaced.set_vertical(0, -10'250);
  RobosensePacket packet;
  packet.set_azimuths(1000, 20);
  packet.set_return(0, 0, 1000);
  ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.decode(replaced.bytes(), kReceivedNs).status, DecodeStatus::telemetry);
  packet.set_azimuths(1240, 20);
  packet.set_time_us(666);
  ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs + 666'000).status, DecodeStatus::decoded);
  EXPECT_NEAR(elevation_deg(bench.points()[0]), -10.281, 1e-4);
  EXPECT_NEAR(elevation_deg(bench.points()[1]), -10.250, 1e-4);
}

TEST(RobosenseDecoder, PrefersTheFileThatTheUserGives) {
  std::vector<Beam> beams(32);
  for (std::size_t i = 0; i < 32; ++i) beams[i].elevation_deg = 16.0 - static_cast<double>(i);
  DecoderBench bench("rs32", {.optical_centre = false}, 1000, beams);
  RobosensePacket packet;
  packet.set_azimuths(1000, 20);
  packet.set_return(0, 3, 1000);
  const RobosenseDeviceInfo unit = test::robosense_unit("rs32");
  EXPECT_EQ(bench.decode(unit.bytes(), kReceivedNs).status, DecodeStatus::telemetry);
  EXPECT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 1U);
  EXPECT_NEAR(elevation_deg(bench.points()[0]), 13.0, 1e-4);
  EXPECT_EQ(bench.points()[0].ring, 28);
}

TEST(RobosenseDecoder, PlacesAPointAsTheManualDoes) {
  DecoderBench bench = bench_of("rs32", {});
  RobosensePacket packet;
  packet.set_azimuths(9000, 20);
  packet.set_return(0, 9, 0x8348, 77);  // 168.04 m, horizontal -2.672 deg
  ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 1U);
  const Point& point = bench.points()[0];
  const double a = (90.0 + 0.2 * 25.92 / 55.52) / kDegPerRad;
  const double h = a - 2.672 / kDegPerRad;
  EXPECT_NEAR(point.x, 168.04 * std::cos(h) + 0.03997 * std::cos(a), 2e-5);
  EXPECT_NEAR(point.y, -168.04 * std::sin(h) - 0.03997 * std::sin(a), 2e-5);
  EXPECT_NEAR(point.z, 0.0, 1e-6);
  EXPECT_EQ(point.intensity, 77.0F);
  EXPECT_EQ(point.ring, 20) << "twenty lasers look further down";
}

TEST(RobosenseDecoder, TimesFiringsAsTheManualIncludingItsOddity) {
  for (const std::size_t returns : {1U, 2U}) {
    DecoderBench bench = bench_of("rs32");
    RobosensePacket packet;
    packet.set_azimuths(9000, 20, returns);
    packet.set_time_us(123'456);
    for (const std::size_t slot : {0U, 1U, 14U, 15U, 16U, 31U}) packet.set_return(10, slot, 1000);
    ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs + 123'456'000).status, DecodeStatus::decoded);
    ASSERT_TRUE(bench.flush());
    const auto& sweep = bench.swept().at(0);
    EXPECT_EQ(sweep.start_utc_ns, RobosensePacket::kTimeUtcNs + 123'456'000);
    EXPECT_EQ(sweep.time_source, TimeSource::sensor);
    ASSERT_EQ(sweep.points.size(), 6U);
    const std::size_t firings_before = 10 / returns;
    const double before_us = static_cast<double>(firings_before) * 55.52;
    const double expected_us[] = {0.0, 2.88, 40.32, 44.64, 1.44, 46.08};
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(1e6 * static_cast<double>(sweep.points[i].time_s), before_us + expected_us[i], 1e-3) << i;
      const double turned_deg = 0.2 * (before_us + expected_us[i]) / 55.52;
      const int slots[] = {0, 1, 14, 15, 16, 31};
      const double offset_deg = test::kRs32AnglesMilliDeg[static_cast<std::size_t>(slots[i])][1] * 1e-3;
      EXPECT_NEAR(azimuth_deg(sweep.points[i]), 90.0 + turned_deg + offset_deg, 2e-5) << i;
    }
  }
}

TEST(RobosenseDecoder, TurnsTheLastBlockAndThoseAtAGapByTheSpeedOfTheOthers) {
  DecoderBench bench = bench_of("rs32");
  RobosensePacket packet;
  packet.set_azimuths(9000, 40);  // 1200 rpm
  for (std::size_t block = 6; block < 12; ++block)
    packet.set_azimuth(block, 21'000 + 40 * static_cast<unsigned>(block - 6));
  for (const std::size_t block : {4U, 5U, 6U, 11U}) packet.set_return(block, 15, 1000);
  ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 4U);
  const double turned_deg = 0.4 * 44.64 / 55.52 + 8.0;
  EXPECT_NEAR(azimuth_deg(bench.points()[0]), 91.6 + turned_deg, 2e-5);
  EXPECT_NEAR(azimuth_deg(bench.points()[1]), 92.0 + turned_deg, 2e-5);
  EXPECT_NEAR(azimuth_deg(bench.points()[2]), 210.0 + turned_deg, 2e-5);
  EXPECT_NEAR(azimuth_deg(bench.points()[3]), 212.0 + turned_deg, 2e-5);
  // The rotor turned on from 92 to 210 deg without firing.
  const double gap_us = 118.0 / 0.4 * 55.52;
  const auto times = bench.points();
  EXPECT_NEAR(1e6 * static_cast<double>(times[2].time_s - times[1].time_s), gap_us, 0.01);
  EXPECT_NEAR(1e6 * static_cast<double>(times[3].time_s - times[2].time_s), 5 * 55.52, 0.01);
}

TEST(RobosenseDecoder, TellsDualReturnsByTheirEqualAzimuths) {
  DecoderBench bench = bench_of("rs32");  // whose device information says single
  RobosensePacket packet;
  packet.set_azimuths(9000, 20, 2);
  packet.set_return(4, 3, 1000, 10);
  packet.set_return(5, 3, 2000, 20);
  packet.set_return(4, 4, 1000, 30);
  packet.set_return(5, 4, 1000, 40);  // the same point again
  ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 3U);
  EXPECT_EQ(bench.points()[0].intensity, 10.0F);
  EXPECT_EQ(bench.points()[1].intensity, 30.0F);
  EXPECT_EQ(bench.points()[2].intensity, 20.0F);
  EXPECT_EQ(bench.points()[0].time_s, bench.points()[2].time_s);
  EXPECT_NEAR(azimuth_deg(bench.points()[0]), azimuth_deg(bench.points()[2]), 1e-5);
}

TEST(RobosenseDecoder, HoldsFullTurnsOf1801FiringsAt600Rpm) {
  EXPECT_EQ(static_cast<int>(1.0 / (10.0 * 55.52e-6)), 1801);
  EXPECT_EQ(static_cast<int>(1.0 / (20.0 * 55.52e-6)), 900);
  DecoderBench bench = bench_of("rs32");
  std::size_t firings = 0;
  for (unsigned i = 0; i < 1500; ++i) {
    RobosensePacket packet;
    for (unsigned block = 0; block < 12; ++block) {
      const double turned_us = (i * 12 + block) * 55.52;
      packet.set_azimuth(block, static_cast<unsigned>(std::lround(turned_us * 0.36)) % 36000);
      packet.set_return(block, 0, 1000);
    }
    packet.set_time_us(static_cast<std::int64_t>(i * 12 * 55.52));
    const auto result = bench.decode(packet.bytes(), kReceivedNs + static_cast<std::int64_t>(i) * 666'240);
    ASSERT_EQ(result.status, DecodeStatus::decoded);
  }
  ASSERT_GE(bench.swept().size(), 8U);
  for (std::size_t i = 1; i < bench.swept().size(); ++i) {
    firings = bench.swept()[i].points.size();
    EXPECT_TRUE(bench.swept()[i].complete) << i;
    EXPECT_TRUE(firings == 1801 || firings == 1802) << firings;
  }
}

TEST(RobosenseDecoder, AnchorsAClockThatWasNeverSet) {
  DecoderBench bench = bench_of("rs32");
  RobosensePacket packet;
  packet.set_azimuths(9000, 20);
  packet.set_byte(20, 0);  // 2000-11-14
  packet.set_return(0, 0, 1000);
  ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  ASSERT_TRUE(bench.flush());
  EXPECT_EQ(bench.swept()[0].time_source, TimeSource::receive);
  EXPECT_EQ(bench.swept()[0].start_utc_ns, kReceivedNs);
  // A clock that runs 37 s ahead follows atomic time: not UTC, and so not believed either.
  DecoderBench atomic = bench_of("helios16p");
  RobosensePacket helios("helios16p");
  helios.set_azimuths(9000, 40);
  helios.set_time_us(37'000'000);
  helios.set_return(0, 0, 1000);
  ASSERT_EQ(atomic.decode(helios.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  ASSERT_TRUE(atomic.flush());
  EXPECT_EQ(atomic.swept()[0].time_source, TimeSource::receive);
}

TEST(RobosenseDecoder, ReadsTheTwoFirmwaresOfTheRs32) {
  RobosensePacket packet;
  packet.set_azimuths(9000, 20);
  packet.set_return(0, 1, 0x0348, 1);           // group A, 8.40 m of laser 2
  packet.set_return(1, 1, 0x8000 + 0x0348, 2);  // group B, of laser 18
  packet.set_return(1, 17, 0x8000 + 1000, 3);   // of laser 2, 10 m
  packet.set_return(1, 20, 0x8000, 4);          // nothing
  const auto check = [&](DecoderBench& bench) {
    ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
    ASSERT_EQ(bench.points().size(), 3U);
    EXPECT_NEAR(range_of(bench.points()[0]), 8.40, 1e-5);
    EXPECT_NEAR(elevation_deg(bench.points()[0]), -6.424, 1e-4);
    EXPECT_NEAR(range_of(bench.points()[1]), 10.0, 1e-5);
    EXPECT_NEAR(elevation_deg(bench.points()[1]), -6.424, 1e-4);
    EXPECT_EQ(bench.points()[1].intensity, 3.0F);
    EXPECT_NEAR(range_of(bench.points()[2]), 8.40, 1e-5);
    EXPECT_NEAR(elevation_deg(bench.points()[2]), -14.638, 1e-4);
  };
  RobosenseDeviceInfo old = test::robosense_unit("rs32");
  old.set_top_firmware(0xE90100);
  DecoderBench by_version("rs32", {.optical_centre = false});
  ASSERT_EQ(by_version.decode(old.bytes()).status, DecodeStatus::telemetry);
  check(by_version);
  DecoderBench by_choice = bench_of("rs32", {.range_unit_m = 0.01, .optical_centre = false});
  check(by_choice);

  DecoderBench today("rs32", {.range_unit_m = 0.005, .optical_centre = false});
  ASSERT_EQ(today.decode(old.bytes()).status, DecodeStatus::telemetry);
  ASSERT_EQ(today.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  ASSERT_EQ(today.points().size(), 4U);
  EXPECT_NEAR(range_of(today.points()[0]), 4.2, 1e-5);
  EXPECT_NEAR(range_of(today.points()[1]), 168.04, 1e-4);
}

TEST(RobosenseDecoder, KeepsDualReturnsOfTheOldFirmwareInTheirGroups) {
  DecoderBench bench = bench_of("rs32", {.range_unit_m = 0.01, .optical_centre = false});
  RobosensePacket packet;
  packet.set_azimuths(9000, 20, 2);
  packet.set_return(2, 16, 0x8000 + 500, 1);
  packet.set_return(3, 16, 0x8000 + 700, 2);
  packet.set_return(2, 2, 0x8000 + 900, 3);
  packet.set_return(3, 2, 0x8000 + 900, 4);
  ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 3U);
  EXPECT_NEAR(elevation_deg(bench.points()[0]), -10.281, 1e-4);
  EXPECT_NEAR(range_of(bench.points()[0]), 5.0, 1e-5);
  EXPECT_NEAR(elevation_deg(bench.points()[1]), -7.910, 1e-4);
  EXPECT_NEAR(range_of(bench.points()[2]), 7.0, 1e-5);
}

TEST(RobosenseDecoder, SeesThatTheRangesContradictTheFirmware) {
  RobosensePacket packet;
  packet.set_azimuths(9000, 20);
  for (std::size_t slot = 0; slot < 8; ++slot) packet.set_return(3, slot, 0x8000 + 500);
  DecoderBench bench = bench_of("rs32");
  EXPECT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::wrong_header)
      << "eight returns of group B, or all of them from beyond 163 m";
  DecoderBench trusting = bench_of("rs32", {.range_unit_m = 0.005});
  EXPECT_EQ(trusting.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  DecoderBench old = bench_of("rs32", {.range_unit_m = 0.01});
  EXPECT_EQ(old.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  packet.set_return(3, 9, 500);
  EXPECT_EQ(old.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::wrong_header) << "of both groups";
}

TEST(RobosenseDecoder, RefusesAPacketThatIsNotWhatItShouldBe) {
  for (const char* const model : {"rs32", "rs16", "helios16p"}) {
    DecoderBench bench = bench_of(model);
    const auto status = [&](auto change) {
      RobosensePacket packet(model);
      packet.set_azimuths(1000, 20);
      packet.set_return(0, 0, 1000);
      change(packet);
      return bench.decode(packet.bytes(), kReceivedNs).status;
    };
    EXPECT_EQ(status([](auto& p) { p.set_byte(1, 0xAB); }), DecodeStatus::wrong_header) << model;
    EXPECT_EQ(status([](auto& p) { p.set_flag(7, 0xFFEF); }), DecodeStatus::wrong_header) << model;
    EXPECT_EQ(status([](auto& p) { p.set_flag(11, 0); }), DecodeStatus::wrong_header) << model;
    EXPECT_EQ(status([](auto& p) { p.set_byte(1247, 0xF0); }), DecodeStatus::wrong_header) << model;
    EXPECT_EQ(status([](auto& p) { p.set_azimuth(5, 36000); }), DecodeStatus::wrong_azimuth) << model;
    EXPECT_EQ(status([](auto& p) { p.set_azimuths(0, 17000); }), DecodeStatus::wrong_azimuth) << model;
    RobosensePacket other(model == std::string_view("helios16p") ? "rs32" : "helios16p");
    EXPECT_EQ(bench.decode(other.bytes()).status, DecodeStatus::wrong_model) << model;
    EXPECT_TRUE(bench.all_points().empty());
  }
}

TEST(RobosenseDecoder, RefusesWhatIsNoTime) {
  DecoderBench calendar = bench_of("rs32");
  const auto status = [](DecoderBench& bench, const char* model, std::size_t at, unsigned value) {
    RobosensePacket packet(model);
    packet.set_azimuths(1000, 20);
    packet.set_byte(at, value);
    return bench.decode(packet.bytes(), kReceivedNs).status;
  };
  EXPECT_EQ(status(calendar, "rs32", 20, 100), DecodeStatus::wrong_time);  // the year 2100
  EXPECT_EQ(status(calendar, "rs32", 21, 0), DecodeStatus::wrong_time);
  EXPECT_EQ(status(calendar, "rs32", 22, 31), DecodeStatus::wrong_time);  // of November
  EXPECT_EQ(status(calendar, "rs32", 23, 24), DecodeStatus::wrong_time);
  EXPECT_EQ(status(calendar, "rs32", 26, 4), DecodeStatus::wrong_time);  // 1024 ms
  EXPECT_EQ(status(calendar, "rs32", 28, 4), DecodeStatus::wrong_time);  // 1024 us
  DecoderBench seconds = bench_of("helios16p");
  EXPECT_EQ(status(seconds, "helios16p", 20, 1), DecodeStatus::wrong_time);    // the year 36,000
  EXPECT_EQ(status(seconds, "helios16p", 26, 1), DecodeStatus::wrong_time);    // 16.8 s of microseconds
  EXPECT_EQ(status(seconds, "helios16p", 17, 2), DecodeStatus::wrong_header);  // unit of the ranges
}

TEST(RobosenseDecoder, FiresSixteenLasersTwiceABlock) {
  DecoderBench bench = bench_of("rs16");
  RobosensePacket packet("rs16");
  packet.set_azimuths(9000, 40);
  packet.set_return(1, 15, 1000, 1);
  packet.set_return(1, 16, 1000, 2);
  packet.set_return(11, 31, 2000, 3);
  ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 3U);
  const double expected_us[] = {111.0 + 42.0, 111.0 + 55.5, 11 * 111.0 + 97.5};
  const double expected_deg[] = {1.0, -15.0, 1.0};
  const int rings[] = {8, 0, 8};
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& point = bench.points()[i];
    EXPECT_NEAR(1e6 * static_cast<double>(point.time_s), expected_us[i], 1e-3);
    EXPECT_NEAR(azimuth_deg(point), 90.0 + 0.4 * expected_us[i] / 111.0, 2e-5);
    EXPECT_NEAR(elevation_deg(point), expected_deg[i], 1e-4);
    EXPECT_EQ(point.ring, rings[i]);
  }
  EXPECT_NEAR(range_of(bench.points()[2]), 10.0, 1e-5);
}

TEST(RobosenseDecoder, FindsTheTwoReturnsOfSixteenLasersInABlock) {
  DecoderBench bench("rs16", {.optical_centre = false});
  RobosenseDeviceInfo unit = test::robosense_unit("rs16");
  unit.set_return_mode(0);
  ASSERT_EQ(bench.decode(unit.bytes()).status, DecodeStatus::telemetry);
  RobosensePacket packet("rs16");
  packet.set_azimuths(9000, 20);
  packet.set_return(1, 15, 1000, 1);
  packet.set_return(1, 31, 2000, 2);
  packet.set_return(2, 3, 1500, 3);
  packet.set_return(2, 19, 1500, 4);  // the same point again
  ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 3U);
  const double expected_us[] = {55.5 + 42.0, 55.5 + 42.0, 111.0 + 8.4};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(1e6 * static_cast<double>(bench.points()[i].time_s), expected_us[i], 1e-3);
    EXPECT_NEAR(azimuth_deg(bench.points()[i]), 90.0 + 0.2 * expected_us[i] / 55.5, 2e-5);
    EXPECT_EQ(bench.points()[i].ring, i < 2 ? 8 : 3);
  }
  EXPECT_EQ(bench.points()[1].intensity, 2.0F);
}

TEST(RobosenseDecoder, TellsTheTwoReturnsOfSixteenLasersByThePaceAtEverySpeed) {
  // 1200 rpm: a block of two returns turns as far as one of two firings does at 600 rpm. The time between
  // packets tells them apart, although no device information has said how fast the rotor turns.
  DecoderBench bench("rs16", {}, 1000, std::vector<Beam>(16));
  for (unsigned i = 0; i < 4; ++i) {
    RobosensePacket packet("rs16");
    packet.set_azimuths(9000 + 480 * i, 40);
    packet.set_time_us(666 * static_cast<std::int64_t>(i));
    packet.set_return(1, 0, 1000, 1);
    packet.set_return(1, 16, 1000, 2);
    const auto result = bench.decode(packet.bytes(), kReceivedNs + 666'000 * std::int64_t{i});
    ASSERT_EQ(result.status, DecodeStatus::decoded);
  }
  EXPECT_EQ(bench.points().size(), 5U) << "the first packet cannot be told; equal returns after it";
}

TEST(RobosenseDecoder, ReadsTheHeliosUnitOfRanges) {
  for (const auto& [choice, range_m] : {std::pair{0U, 5.0}, {1U, 2.5}}) {
    DecoderBench bench = bench_of("helios16p");
    RobosensePacket packet("helios16p");
    packet.set_azimuths(9000, 40);
    packet.set_byte(17, choice);
    packet.set_return(0, 17, 1000);
    ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
    ASSERT_EQ(bench.points().size(), 1U);
    EXPECT_NEAR(range_of(bench.points()[0]), range_m, 1e-5);
    EXPECT_NEAR(1e6 * static_cast<double>(bench.points()[0].time_s), 55.56 + 3.15, 1e-3);
    EXPECT_NEAR(elevation_deg(bench.points()[0]), 13.0, 1e-4);
  }
}

TEST(RobosenseDecoder, TakesDeviceInformationForASingleReturnAtItsWordAboutHelios) {
  // A recorded unit in single return turns half as far a block as a Helios-16P should.
  DecoderBench bench = bench_of("helios16p");
  RobosensePacket packet("helios16p");
  packet.set_azimuths(9000, 20);
  packet.set_return(1, 2, 1000);
  packet.set_return(1, 18, 1000);
  ASSERT_EQ(bench.decode(packet.bytes(), kReceivedNs).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 2U) << "no two returns of one firing: equal ranges are two points";
  EXPECT_NEAR(1e6 * static_cast<double>(bench.points()[1].time_s), 55.56 + (55.56 + 6.30) / 2, 1e-3);
}

TEST(RobosenseDecoder, IsRecognisedByTheMagicThatModelsMayShare) {
  const auto looks = [](const char* name, std::span<const std::byte> payload) {
    return looks_like(*find_sensor_model(name), payload);
  };
  const RobosensePacket rs("rs32");
  const RobosensePacket helios("helios16p");
  EXPECT_TRUE(looks("rs32", rs.bytes()));
  EXPECT_TRUE(looks("rs16", rs.bytes()));
  EXPECT_FALSE(looks("helios16p", rs.bytes()));
  EXPECT_TRUE(looks("helios16p", helios.bytes()));
  EXPECT_FALSE(looks("rs32", helios.bytes()));
  EXPECT_FALSE(looks("rs32", rs.bytes().first(1247)));
  EXPECT_FALSE(looks("rs32", test::robosense_unit("rs32").bytes()));
}

}  // namespace
}  // namespace landfix::drivers
