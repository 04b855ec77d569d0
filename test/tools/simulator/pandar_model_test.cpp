// The Pandars' tables and bytes against the manuals. Independent checks of the same tables: the Pandar64's
// azimuth offsets, firing times and the optical centre by the walls of a recording, and its arithmetic by
// another driver's cloud (test/real/pandar64_real_test.cpp). There is no recording of a Pandar40P: its
// elevations are held against the rounded list of its manual and against the Pandar64, which has the same
// optics; its firing times against the two charging times that all of them are made of.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/lidar_model_probe.hpp"
#include "tools/simulator/pandar_tables.hpp"

namespace landfix::tools::simulator {
namespace {

using test::byte_at;
using test::kFullHour_utc_ns;
using test::little_at;
using test::shots_at;

TEST(PandarTables, AgreeWithTheRoundedListOfThePandar40pManual) {
  // Appendix I: elevation in steps of a third of a degree, and the column of emitters the laser sits in.
  constexpr double kElevations_deg[] = {15,   11,    8,     5,     3,     2,     1.67,  1.33,  1,     0.67,
                                        0.33, 0,     -0.33, -0.67, -1,    -1.33, -1.67, -2,    -2.33, -2.67,
                                        -3,   -3.33, -3.67, -4,    -4.33, -4.67, -5,    -5.33, -5.67, -6,
                                        -7,   -8,    -9,    -10,   -11,   -12,   -13,   -14,   -19,   -25};
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_NEAR(kPandar40pChannels[i].elevation_deg, kElevations_deg[i], 0.13) << i + 1;
    // From channel 6 to 30 the columns take turns: -1.042, 3.125, -5.208.
    const double offset_deg = i < 5 || i > 29 ? -1.042 : std::array{-5.208, -1.042, 3.125}[(i + 2) % 3];
    EXPECT_EQ(kPandar40pChannels[i].azimuth_offset_deg, i == 5 ? -1.042 : offset_deg) << i + 1;
  }
}

TEST(PandarTables, ThePandar40pHasTheOpticsOfThePandar64) {
  int same = 0;
  for (const PandarChannel& channel : kPandar40pChannels) {
    const auto is_same = [&channel](const PandarChannel& other) {
      return other.elevation_deg == channel.elevation_deg &&
             other.azimuth_offset_deg == channel.azimuth_offset_deg;
    };
    if (std::ranges::any_of(kPandar64Channels, is_same)) {
      ++same;
    } else {
      // The two lists leave open which of them is right.
      EXPECT_EQ(channel.elevation_deg, -10.045);
      EXPECT_EQ(kPandar64Channels[57].elevation_deg, -9.885);
    }
  }
  EXPECT_EQ(same, 39);
}

/// Firing times are the last, 3.62 us before the block's end, and so many of two waiting times before it.
void expect_made_of_two_times(std::span<const PandarChannel> channels, double rounding_us) {
  std::map<long, int> at_ns;
  for (const PandarChannel& channel : channels) {
    ++at_ns[std::lround(1e3 * channel.firing_time_us)];
    double nearest_us = 1.0;
    for (int i = 0; i <= 15; ++i) {
      for (int j = 0; j <= 16; ++j) {
        nearest_us = std::min(nearest_us, std::abs(channel.firing_time_us + 3.62 + 1.304 * i + 1.968 * j));
      }
    }
    EXPECT_LT(nearest_us, rounding_us) << channel.firing_time_us;
  }
  EXPECT_EQ(at_ns.size(), 32U);
  for (const auto& [ns, lasers] : at_ns) EXPECT_LE(lasers, 2) << ns;
  EXPECT_NEAR(static_cast<double>(at_ns.rbegin()->first), -3620, 1);
  EXPECT_NEAR(static_cast<double>(at_ns.begin()->first), -54669, 2);
  for (auto next = std::next(at_ns.begin()); next != at_ns.end(); ++next) {
    const auto step_ns = static_cast<double>(next->first - std::prev(next)->first);
    EXPECT_LT(std::min(std::abs(step_ns - 1304.0), std::abs(step_ns - 1968.0)), 2e3 * rounding_us);
  }
}

TEST(PandarTables, FiringTimesAreMadeOfTwoChargingTimes) {
  expect_made_of_two_times(kPandar64Channels, 1e-9 + 0.0005);
  expect_made_of_two_times(kPandar40pChannels, 0.0065);  // given in hundredths of a microsecond
}

TEST(PandarModel, FiresAsTheManualTimesIt) {
  struct Example {
    const char* name;
    std::size_t channels;
    std::size_t blocks;
    double last_block_us;  // its end, before the packet's time
    double earliest_us;    // shot, before the packet's time
  };
  for (const Example& example :
       {Example{"pandar64", 64, 6, -42.58, -375.048}, Example{"pandar40p", 40, 10, -28.58, -583.29}}) {
    const auto model = make_lidar_model(example.name);
    const auto shots = shots_at(*model, kFullHour_utc_ns);
    ASSERT_EQ(shots.size(), example.channels * example.blocks);
    const std::int64_t packet_ns = static_cast<std::int64_t>(example.blocks) * 55'560;
    EXPECT_EQ(model->traits().packet_ns, packet_ns);
    const auto packed_ns = static_cast<double>(packet_ns) - 1e3 * example.last_block_us;
    const auto first = std::ranges::min(shots, {}, &Shot::after_ns);
    EXPECT_NEAR(static_cast<double>(first.after_ns), packed_ns + 1e3 * example.earliest_us, 1.0);
    EXPECT_GE(first.after_ns, 0);
    EXPECT_EQ(shots[example.channels].after_ns - shots[0].after_ns, 55'560);
    EXPECT_LT(std::ranges::max(shots, {}, &Shot::after_ns).after_ns, packet_ns);
  }
}

TEST(PandarModel, BeamsStartBesideTheAxisAndTurnWithIt) {
  const auto model = make_lidar_model("pandar40p");
  for (const std::int64_t quarter : {0, 1, 2, 3}) {
    const Shot shot = shots_at(*model, kFullHour_utc_ns + quarter * 25'000'000)[11];
    const double rotor_deg =
        90.0 * static_cast<double>(quarter) + 3600e-9 * static_cast<double>(shot.after_ns);
    EXPECT_NEAR(shot.azimuth_deg, rotor_deg - 1.042, 0.031);
    // 38.73 mm ahead and 12 mm to the left: its direction is 17.215 deg to the left of the rotor's.
    EXPECT_NEAR(shot.origin_m.norm(), 0.0405464, 1e-7);
    const double origin_deg = -std::atan2(shot.origin_m.y(), shot.origin_m.x()) * 180.0 / std::numbers::pi;
    EXPECT_NEAR(std::remainder(origin_deg - rotor_deg + 17.215, 360.0), 0.0, 1e-3) << quarter;
  }
}

TEST(PandarModel, PutsEveryFieldWhereTheManualSays) {
  const std::int64_t utc_ns = kFullHour_utc_ns + 59'999'999'000 - 333'360 - 42'580 + 999;
  std::vector<Echo> echoes(384);
  echoes[0] = {.range_m = 10.0, .reflectivity = 0x5A};
  echoes[383] = {.range_m = 100.0, .reflectivity = 0xFF};
  const auto payload = make_lidar_model("pandar64")->encode(0x0123'4567'89AB, utc_ns, echoes);
  ASSERT_EQ(payload.size(), 1198U);
  const unsigned header[] = {0xEE, 0xFF, 64, 6, 0, 4, 0, 0};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(byte_at(payload, i), header[i]) << i;
  for (std::size_t block = 0; block < 6; ++block) {
    const double turned_us = 59'999'624.059 + 55.56 * static_cast<double>(block + 1);
    EXPECT_NEAR(static_cast<double>(little_at(payload, 8 + 194 * block, 2)),
                std::fmod(0.36 * turned_us, 36000.0), 0.51);
  }
  EXPECT_EQ(byte_at(payload, 12), 0x5AU);
  EXPECT_EQ(byte_at(payload, 8 + 6 * 194 - 1), 0xFFU);
  EXPECT_EQ(little_at(payload, 1172 + 8, 2), 600U);
  EXPECT_EQ(little_at(payload, 1172 + 10, 4), 999'999U);
  const unsigned tail[] = {0x37, 0x42, 126, 5, 4, 8, 0, 59};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(byte_at(payload, 1172 + 14 + i), tail[i]) << i;
  EXPECT_EQ(little_at(payload, 1194, 4), 0x4567'89ABU);
}

TEST(PandarModel, WritesThePandar40pWithoutHeaderAndNumber) {
  const std::int64_t utc_ns = kFullHour_utc_ns + 3'000'000'000 - 555'600 - 28'580;
  std::vector<Echo> echoes(400);
  echoes[399] = {.range_m = 50.0, .reflectivity = 0x11};
  const auto payload = make_lidar_model("pandar40p")->encode(5, utc_ns, echoes);
  ASSERT_EQ(payload.size(), 1262U);
  for (std::size_t block = 0; block < 10; ++block) {
    EXPECT_EQ(byte_at(payload, 124 * block), 0xFFU);
    EXPECT_EQ(byte_at(payload, 124 * block + 1), 0xEEU);
  }
  EXPECT_EQ(byte_at(payload, 1239), 0x11U);
  EXPECT_EQ(little_at(payload, 1240 + 10, 4), 0U);
  const unsigned tail[] = {0x37, 0x42, 26, 5, 4, 8, 0, 3};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(byte_at(payload, 1240 + 14 + i), tail[i]) << i;
}

TEST(PandarModel, MeasuresFromItsCentreAlthoughTheBeamStartsBesideIt) {
  const auto model = make_lidar_model("pandar64");
  for (const double range_m : {0.5, 5.0, 150.0}) {
    const std::vector<Echo> echoes(384, Echo{.range_m = range_m, .reflectivity = 1});
    const auto payload = model->encode(0, kFullHour_utc_ns, echoes);
    const auto shots = shots_at(*model, kFullHour_utc_ns);
    for (const std::size_t shot : {0UL, 63UL, 200UL}) {
      const std::size_t at = 8 + 194 * (shot / 64) + 2 + 3 * (shot % 64);
      const double measured_m = 0.004 * static_cast<double>(little_at(payload, at, 2));
      // The centre is up to 38.73 mm behind the origin, seen along the beam.
      const double behind_m = shots[shot].origin_m.dot(shots[shot].direction());
      EXPECT_NEAR(measured_m, range_m + behind_m, 0.0021 + 0.001 / range_m) << range_m;
      EXPECT_GT(behind_m, 0.03);
    }
  }
}

TEST(PandarModel, BringsTheAnglesOfItsOwnUnit) {
  for (const char* const name : {"pandar64", "pandar40p"}) {
    const auto model = make_lidar_model(name);
    const auto shots = shots_at(*model, kFullHour_utc_ns);
    const std::span<const PandarChannel> table = std::string_view(name) == "pandar64"
                                                     ? std::span<const PandarChannel>(kPandar64Channels)
                                                     : std::span<const PandarChannel>(kPandar40pChannels);
    std::string text = "Laser id,Elevation,Azimuth\n";
    std::set<long> apart_mdeg;
    for (std::size_t i = 0; i < table.size(); ++i) {
      EXPECT_NEAR(shots[i].elevation_deg, table[i].elevation_deg - 0.06, 0.031);
      apart_mdeg.insert(std::lround(1e3 * (shots[i].elevation_deg - table[i].elevation_deg)));
      const double rotor_deg = 3600e-9 * static_cast<double>(shots[i].after_ns);
      const double offset_deg = shots[i].azimuth_deg - rotor_deg;
      EXPECT_NEAR(offset_deg, table[i].azimuth_offset_deg, 0.031);
      std::array<char, 64> line{};
      std::snprintf(line.data(), line.size(), "%zu,%.3f,%.3f\n", i + 1, shots[i].elevation_deg, offset_deg);
      text += line.data();
    }
    EXPECT_GT(apart_mdeg.size(), 20U) << "each channel its own";
    EXPECT_EQ(model->calibration().value().text, text);
  }
}

TEST(PandarGpsPacket, CarriesTheDateInDigitsFromBehindAndASentence) {
  const auto payload = make_lidar_model("pandar40p")
                           ->encode_telemetry({.utc_ns = kFullHour_utc_ns + 901'000'007'000,
                                               .latitude_deg = 48.1173,
                                               .longitude_deg = -11.5});
  ASSERT_EQ(payload.size(), 512U);
  std::string text;
  for (std::size_t at = 0; at < 512; ++at) text += static_cast<char>(byte_at(payload, at));
  EXPECT_EQ(text.substr(0, 14),
            "\xFF\xEE"
            "625040"
            "105180");  // 26-05-04, 08:15:01
  EXPECT_EQ(little_at(payload, 14, 4), 7U);
  EXPECT_EQ(text.substr(18, 46), "$GPRMC,081501,A,4807.0380,N,01130.0000,W,000.0");
  EXPECT_EQ(text.substr(505, 3),
            "\xDF"
            "A\x01");
}

}  // namespace
}  // namespace landfix::tools::simulator
