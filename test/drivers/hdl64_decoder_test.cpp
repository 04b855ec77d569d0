#include "drivers/velodyne/hdl64_decoder.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/decoder_bench.hpp"
#include "support/hdl64_packets.hpp"

namespace landfix::drivers {
namespace {

using test::DecoderBench;
using test::hdl64_packet;
using test::hdl64s1_packet;
using test::kHourUtcNs;
using test::kTopOfHourUs;
using test::VelodynePacket;
using velodyne::Hdl64Calibration;
using velodyne::Hdl64Laser;

/// Two lasers of a real S2.1; the others at rest.
Hdl64Calibration s21_unit() {
  Hdl64Calibration calibration;
  calibration.lasers[0] = Hdl64Laser{.rotation_deg = -7.155916,
                                     .elevation_deg = -8.768623,
                                     .range_m = 1.519526,
                                     .range_x_m = 1.550030,
                                     .range_y_m = 1.523138,
                                     .vertical_offset_m = 0.19548,
                                     .horizontal_offset_m = 0.0260,
                                     .focal_distance_m = 12.0,
                                     .focal_slope = 1.4,
                                     .min_intensity = 30,
                                     .max_intensity = 235};
  calibration.lasers[40] = Hdl64Laser{.rotation_deg = 6.166837,
                                      .elevation_deg = -20.859316,
                                      .range_m = 1.244738,
                                      .range_x_m = 1.313186,
                                      .range_y_m = 1.354245,
                                      .vertical_offset_m = 0.11047,
                                      .horizontal_offset_m = 0.0260,
                                      .focal_distance_m = 6.5,
                                      .focal_slope = 1.0,
                                      .min_intensity = 25,
                                      .max_intensity = 255};
  return calibration;
}

DecoderBench bench_of(std::string_view model, const Hdl64Calibration& calibration = {},
                      const DecoderOptions& options = {}) {
  return DecoderBench(model, options, 100'000, calibration);
}

/// One return of a laser in the first firing, at 3600 deg/s.
VelodynePacket one_return(unsigned azimuth_centideg, std::size_t laser, unsigned range_raw,
                          unsigned intensity) {
  auto packet = hdl64_packet(azimuth_centideg, 17);
  for (std::size_t firing = 0; firing < 6; ++firing) {
    const auto turned = static_cast<unsigned>(std::lround(17.28 * static_cast<double>(firing)));
    packet.set_azimuth(2 * firing, azimuth_centideg + turned);
    packet.set_azimuth(2 * firing + 1, azimuth_centideg + turned);
  }
  packet.set_return(laser / 32, laser % 32, range_raw, intensity);
  packet.set_time_us(kTopOfHourUs);
  return packet;
}

struct WorkedNumber {
  std::size_t laser;
  unsigned azimuth_centideg;
  unsigned range_raw;
  bool firing_time_azimuth;
  float x, y, z, intensity;
};

TEST(Hdl64Decoder, GivesTheNumbersWorkedByHandFromTheManual) {
  constexpr WorkedNumber kNumbers[] = {
      {0, 9000, 4000, false, -1.1466F, -9.3590F, -1.2563F, 80.24F},
      {40, 20000, 3000, false, -6.6591F, 1.6092F, -2.5003F, 61.87F},
      {40, 20000, 20000, true, -37.4229F, 9.2181F, -14.5757F, 167.64F},  // beyond 25 m
  };
  for (const char* const model : {"hdl64s1", "hdl64s2", "hdl64s3"}) {
    for (const WorkedNumber& number : kNumbers) {
      auto bench = bench_of(model, s21_unit(), {.firing_time_azimuth = number.firing_time_azimuth});
      const auto packet = one_return(number.azimuth_centideg, number.laser, number.range_raw, 60);
      ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
      const auto points = bench.all_points();
      ASSERT_EQ(points.size(), 1U);
      // The steps of the encoder say 3583 deg/s: 0.0002 deg over the 12 us to the firing.
      const float tolerance = number.firing_time_azimuth ? 3e-4F : 6e-5F;
      EXPECT_NEAR(points[0].x, number.x, tolerance) << number.laser;
      EXPECT_NEAR(points[0].y, number.y, tolerance) << number.laser;
      EXPECT_NEAR(points[0].z, number.z, 6e-5) << number.laser;
      EXPECT_NEAR(points[0].intensity, number.intensity, 5e-3) << number.laser;
    }
  }
}

TEST(Hdl64Decoder, LeavesCorrectionsOutWhenAskedTo) {
  const auto point_with = [](const DecoderOptions& options, const Hdl64Calibration& calibration) {
    auto bench = bench_of("hdl64s2", calibration, options);
    static_cast<void>(bench.decode(one_return(9000, 0, 4000, 20).bytes()));
    return bench.all_points().at(0);
  };
  const Hdl64Calibration unit = s21_unit();
  const Point far_alone = point_with({.firing_time_azimuth = false, .two_point_correction = false}, unit);
  const double elevation_rad = -8.768623 * std::numbers::pi / 180.0;
  EXPECT_NEAR(far_alone.z, (8.0 + 1.519526) * std::sin(elevation_rad) + 0.19548, 1e-5);
  EXPECT_NEAR(std::hypot(far_alone.x, far_alone.y),
              std::hypot((8.0 + 1.519526) * std::cos(elevation_rad), 0.026), 1e-5);
  const Point level = point_with({.vertical_offsets = false}, unit);
  EXPECT_NEAR(level.z, -1.2563 - 0.19548, 1e-4);

  // At power level 0xA8 the sensor has corrected the intensity: no correction, no bounds.
  Hdl64Calibration corrected = unit;
  corrected.intensity_is_corrected = true;
  EXPECT_EQ(point_with({}, corrected).intensity, 20.0F);
  Hdl64Calibration bounded = unit;
  bounded.lasers[0].focal_slope = 0.0;
  EXPECT_EQ(point_with({}, bounded).intensity, 30.0F);
  bounded.lasers[0].focal_slope = 100.0;
  EXPECT_EQ(point_with({}, bounded).intensity, 235.0F);
}

TEST(Hdl64Decoder, TimesEveryLaserOfEveryFiring) {
  struct Case {
    const char* model;
    VelodynePacket packet;
    std::int64_t duration_ns;
    double last_firing_us;  ///< its first laser, since the packet's first firing
    double four_us[5];      ///< lasers 0 to 4 of a block
    double last_laser_us;
  };
  const Case cases[] = {
      {"hdl64s2", hdl64_packet(1000, 17), 288'000, 240.0, {0, 1.26, 2.46, 3.66, 6.0}, 45.66},
      {"hdl64s3", hdl64_packet(1000, 17), 288'000, 240.0, {0, 1.26, 2.46, 3.66, 6.0}, 45.66},
      {"hdl64s3", hdl64_packet(1000, 21, 2), 172'800, 115.2, {0, 1.3, 2.5, 3.7, 7.2}, 54.1},
      {"hdl64s1", hdl64s1_packet(1000, 11), 384'000, 352.0, {0, 1.0, 2.0, 3.0, 4.0}, 31.0},
  };
  for (const Case& a_case : cases) {
    VelodynePacket packet = a_case.packet;
    packet.set_time_us(kTopOfHourUs);
    for (std::size_t slot = 0; slot < 32; ++slot) {
      packet.set_return(0, slot, 5000);
      packet.set_return(11, slot, 5000);
    }
    auto bench = bench_of(a_case.model);
    ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded) << a_case.model;
    const auto points = bench.all_points();
    ASSERT_EQ(points.size(), 64U);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_NEAR(points[i].time_s, 1e-6 * a_case.four_us[i], 1e-9) << a_case.model;
      EXPECT_NEAR(points[32 + i].time_s, 1e-6 * (a_case.last_firing_us + a_case.four_us[i]), 1e-9);
    }
    EXPECT_NEAR(points[31].time_s, 1e-6 * a_case.last_laser_us, 1e-9) << a_case.model;
    ASSERT_TRUE(bench.flush());
    const auto& sweep = bench.swept().at(0);
    const bool has_clock = a_case.model != std::string_view("hdl64s1");
    const std::int64_t end_ns = has_clock ? kHourUtcNs + 1'000'000'000 : test::kReceiveUtcNs;
    EXPECT_EQ(sweep.start_utc_ns, end_ns - a_case.duration_ns) << "the packet's time is that of its end";
    EXPECT_EQ(sweep.time_source, has_clock ? TimeSource::sensor : TimeSource::receive);
    if (!has_clock) continue;
    auto other = bench_of(a_case.model, {}, {.hdl64_time_is_packet_end = false});
    static_cast<void>(other.decode(packet.bytes()));
    ASSERT_TRUE(other.flush());
    EXPECT_EQ(other.swept().at(0).start_utc_ns, end_ns);
  }
}

TEST(Hdl64Decoder, TurnsEachLaserOnByItsFiringTime) {
  for (const bool dual : {false, true}) {
    auto bench = bench_of("hdl64s3");
    auto packet = dual ? hdl64_packet(1000, 40, 2) : hdl64_packet(1000, 40);
    for (std::size_t block = 0; block < 2; ++block) packet.set_return(block, 31, 5000);
    ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
    const auto points = bench.all_points();
    ASSERT_EQ(points.size(), 2U);
    for (const Point& point : points) {
      const double azimuth_deg =
          -std::atan2(static_cast<double>(point.y), static_cast<double>(point.x)) * 180.0 / std::numbers::pi;
      EXPECT_NEAR(azimuth_deg, 10.0 + 0.4 * (dual ? 54.1 / 57.6 : 45.66 / 48.0), 6e-3);
    }
  }
}

TEST(Hdl64Decoder, KeepsTheOrderOfTheWireAndNoReturnTwice) {
  auto bench = bench_of("hdl64s3");
  auto packet = hdl64_packet(1000, 21, 2);
  packet.set_return(0, 5, 5000, 1);  // upper, strongest
  packet.set_return(2, 5, 6000, 3);  // upper, last
  packet.set_return(1, 5, 5000, 2);  // lower, strongest
  packet.set_return(3, 5, 5000, 9);  // lower, last: the same
  packet.set_return(2, 6, 7000, 4);  // the strongest is missing
  ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
  const auto points = bench.all_points();
  ASSERT_EQ(points.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(points[i].intensity, static_cast<float>(i + 1));
}

TEST(Hdl64Decoder, RanksEqualElevationsInTheOrderOfTheLasers) {
  Hdl64Calibration calibration;
  for (std::size_t i = 0; i < 64; ++i) {
    calibration.lasers[i].elevation_deg = i < 32 ? 1.0 : -static_cast<double>(i);
  }
  calibration.lasers[3].enabled = false;
  auto bench = bench_of("hdl64s2", calibration);
  auto packet = hdl64_packet(1000, 17);
  for (std::size_t slot = 0; slot < 32; ++slot) {
    packet.set_return(0, slot, 5000);
    packet.set_return(1, slot, 5000);
  }
  ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
  const auto points = bench.all_points();
  ASSERT_EQ(points.size(), 63U) << "laser 3 is switched off";
  EXPECT_EQ(points[0].ring, 32);
  EXPECT_EQ(points[3].ring, 36);
  EXPECT_EQ(points[30].ring, 63);
  EXPECT_EQ(points[31].ring, 31);
  EXPECT_EQ(points[62].ring, 0);
}

TEST(Hdl64Decoder, BoundsTheCorrectedRangeNotTheOneOfTheWire) {
  Hdl64Calibration calibration;
  calibration.lasers[0].range_m = calibration.lasers[0].range_x_m = calibration.lasers[0].range_y_m = 1.5;
  auto bench = bench_of("hdl64s2", calibration, {.min_range_m = 2.0, .max_range_m = 3.0});
  constexpr unsigned kRanges[] = {0, 249, 250, 750, 751};
  auto packet = hdl64_packet(1000, 17);
  for (unsigned i = 0; i < 5; ++i) packet.set_return(2 * i, 0, kRanges[i], i);
  ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
  const auto points = bench.all_points();
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].intensity, 2.0F);
  EXPECT_EQ(points[1].intensity, 3.0F);
}

TEST(Hdl64Decoder, RefusesAPacketThatIsNotWhatItShouldBe) {
  auto bench = bench_of("hdl64s2");
  const auto status = [&](auto change) {
    auto packet = hdl64_packet(1000, 17);
    packet.set_return(0, 0, 5000);
    change(packet);
    return bench.decode(packet.bytes()).status;
  };
  EXPECT_EQ(status([](auto& p) { p.set_flag(11, 0xEEFF); }), DecodeStatus::wrong_header);
  EXPECT_EQ(status([](auto& p) { p.set_flag(0, 0xCCFF); }), DecodeStatus::wrong_header);
  EXPECT_EQ(status([](auto& p) { p.set_azimuth(11, 36000); }), DecodeStatus::wrong_azimuth);
  EXPECT_EQ(status([](auto& p) { p.set_azimuth(11, 1400); }), DecodeStatus::wrong_azimuth) << "pair differs";
  EXPECT_EQ(status([](auto& p) { p.set_azimuths(0, 9000, 2); }), DecodeStatus::wrong_azimuth);
  EXPECT_EQ(status([](auto& p) { p.set_time_us(3'700'000'000U); }), DecodeStatus::wrong_time);
  EXPECT_EQ(bench.decode(hdl64s1_packet(1000, 11).bytes()).status, DecodeStatus::wrong_model);
  EXPECT_EQ(bench.decode(VelodynePacket().bytes()).status, DecodeStatus::wrong_header);
  EXPECT_TRUE(bench.all_points().empty());
  EXPECT_EQ(status([](auto&) {}), DecodeStatus::decoded);
  EXPECT_EQ(status([](auto&) {}), DecodeStatus::duplicate);
}

TEST(Hdl64Decoder, GivesNoPointsUntilItIsCalibrated) {
  for (const char* const model : {"hdl64s2", "hdl64s3"}) {
    DecoderBench bench(model);
    EXPECT_EQ(bench.decode(one_return(1000, 0, 5000, 1).bytes()).status, DecodeStatus::uncalibrated);
    EXPECT_TRUE(bench.all_points().empty());
    EXPECT_FALSE(bench.flush());
  }
  EXPECT_THROW(DecoderBench("hdl64s1"), std::runtime_error);
  EXPECT_THROW(DecoderBench("hdl64s2", {}, 10, std::vector<Beam>(64)), std::runtime_error);
  EXPECT_THROW(DecoderBench("vlp16", {}, 10, Hdl64Calibration{}), std::runtime_error);
}

}  // namespace
}  // namespace landfix::drivers
