// RoboSense's tables and bytes against the manuals. Independent checks: the worked examples of the manual
// (firing times, angle encodings), the geometry of the four columns, and, for the Helios, a recorded unit
// whose cloud another driver decoded (test/real/helios_real_test.cpp).
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/decoder_bench.hpp"
#include "support/lidar_model_probe.hpp"

namespace landfix::tools::simulator {
namespace {

using test::big_at;
using test::byte_at;
using test::kFullHour_utc_ns;
using test::shots_at;

TEST(RobosenseModel, FiresThirtyTwoLasersByTheManualsFormula) {
  const auto model = make_lidar_model("rs32");
  const auto shots = shots_at(*model, kFullHour_utc_ns);
  for (std::size_t block = 0; block < 12; ++block) {
    for (std::size_t i = 1; i <= 32; ++i) {
      const auto steps = static_cast<std::int64_t>((i - 1) % 16);
      const auto half =
          static_cast<std::int64_t>(i / 16);  // 16 is counted with the second half, 32 with a third
      EXPECT_EQ(shots[block * 32 + i - 1].after_ns,
                static_cast<std::int64_t>(block) * 55'520 + 2'880 * steps + 1'440 * half);
    }
  }
  EXPECT_EQ(model->traits().packet_ns, 666'240);
}

TEST(RobosenseModel, FiresSixteenLasersTwiceABlock) {
  const auto rs16 = shots_at("rs16", kFullHour_utc_ns);
  EXPECT_EQ(rs16[1].after_ns, 2'800);
  EXPECT_EQ(rs16[15].after_ns, 42'000);
  EXPECT_EQ(rs16[16].after_ns, 55'500);
  EXPECT_EQ(rs16[32 * 11 + 31].after_ns, 11 * 111'000 + 97'500);
  const auto helios = shots_at("helios16p", kFullHour_utc_ns);
  EXPECT_EQ(helios[4].after_ns, 13'260);
  EXPECT_EQ(helios[31].after_ns, 55'560 + 43'910);
  EXPECT_EQ(helios[32].after_ns, 111'120);
}

TEST(RobosenseModel, UnitsLieAroundTheNominalAngles) {
  const auto rs32 = shots_at("rs32", kFullHour_utc_ns);
  // The manual's slot 1 looks -10.281 deg down, slot 10 -2.672 deg aside; four columns, +-8 and +-2.672 deg.
  EXPECT_NEAR(rs32[0].elevation_deg, -10.281, 0.07);
  std::map<int, int> columns;
  for (std::size_t i = 0; i < 32; ++i) {
    const double turned_deg = 3600.0 * 1e-9 * static_cast<double>(rs32[i].after_ns);
    const double offset_deg = rs32[i].azimuth_deg - turned_deg - 0.41;
    for (const double column_deg : {-8.0, -2.672, 2.672, 8.0}) {
      if (std::abs(offset_deg - column_deg) < 0.1) ++columns[static_cast<int>(column_deg)];
    }
  }
  EXPECT_EQ(columns, (std::map<int, int>{{-8, 12}, {-2, 5}, {2, 5}, {8, 10}}));
  const auto rs16 = shots_at("rs16", kFullHour_utc_ns);
  const auto helios = shots_at("helios16p", kFullHour_utc_ns);
  for (std::size_t i = 0; i < 16; ++i) {
    const double step_deg = 2.0 * static_cast<double>(i % 8);
    EXPECT_NEAR(rs16[i].elevation_deg, i < 8 ? -15.0 + step_deg : 15.0 - step_deg, 0.05);
    EXPECT_NEAR(helios[i].elevation_deg, 15.0 - 2.0 * static_cast<double>(i), 0.1);
  }
}

TEST(RobosenseModel, PutsEveryFieldWhereTheManualSays) {
  for (const char* const name : {"rs32", "rs16", "helios16p"}) {
    const bool helios = name == std::string_view("helios16p");
    const auto model = make_lidar_model(name);
    const double unit_m = helios ? 0.0025 : 0.005;
    std::vector<Echo> echoes(384);
    echoes[0] = {.range_m = 0x8348 * unit_m + 0.4 * unit_m, .reflectivity = 0x5A};
    echoes[383] = {.range_m = 0x0102 * unit_m - 0.4 * unit_m, .reflectivity = 0xFF};
    const auto payload = model->encode(0, kFullHour_utc_ns + 123'456'789'000, echoes);
    ASSERT_EQ(payload.size(), 1248U);
    EXPECT_EQ(big_at(payload, 0, 2), 0x55AAU);
    EXPECT_EQ(big_at(payload, 2, 2), helios ? 0x055AU : 0x050AU);
    for (std::size_t block = 0; block < 12; ++block) EXPECT_EQ(big_at(payload, 42 + 100 * block, 2), 0xFFEEU);
    EXPECT_EQ(big_at(payload, 46, 2), 0x8348U);
    EXPECT_EQ(byte_at(payload, 48), 0x5AU);
    EXPECT_EQ(big_at(payload, 1239, 2), 0x0102U);
    EXPECT_EQ(byte_at(payload, 1241), 0xFFU);
    EXPECT_EQ(big_at(payload, 1246, 2), 0x00FFU);
    if (helios) {
      EXPECT_EQ(byte_at(payload, 17), 1U);
      EXPECT_EQ(big_at(payload, 20, 6), 1'777'881'723U);
      EXPECT_EQ(big_at(payload, 26, 4), 456'789U);
    } else {
      const std::array<unsigned, 6> date{26, 5, 4, 8, 2, 3};
      for (std::size_t i = 0; i < date.size(); ++i) EXPECT_EQ(byte_at(payload, 20 + i), date[i]) << i;
      EXPECT_EQ(big_at(payload, 26, 2), 456U);
      EXPECT_EQ(big_at(payload, 28, 2), 789U);
    }
  }
}

TEST(RobosenseModel, SendsItsAnglesOnceASecond) {
  const auto rs32 = make_lidar_model("rs32")->encode_telemetry({.utc_ns = kFullHour_utc_ns});
  ASSERT_EQ(rs32.size(), 1248U);
  EXPECT_EQ(big_at(rs32, 0, 2), 0xA5FFU);
  EXPECT_EQ(big_at(rs32, 8, 2), 600U);
  EXPECT_EQ(byte_at(rs32, 300), 1U);
  EXPECT_EQ(byte_at(rs32, 468), 1U);
  EXPECT_EQ(big_at(rs32, 469, 2), 10'274U);
  EXPECT_EQ(byte_at(rs32, 564), 0U);
  EXPECT_EQ(big_at(rs32, 565, 2), 8'391U);
  EXPECT_EQ(big_at(rs32, 1246, 2), 0x0FF0U);
  const auto rs16 = make_lidar_model("rs16")->encode_telemetry({.utc_ns = kFullHour_utc_ns});
  EXPECT_EQ(big_at(rs16, 1165, 3), 150'300U);
  EXPECT_EQ(big_at(rs16, 1189, 3), 149'860U);
  const auto helios = make_lidar_model("helios16p")->encode_telemetry({.utc_ns = kFullHour_utc_ns});
  EXPECT_EQ(byte_at(helios, 300), 4U);
  EXPECT_EQ(byte_at(helios, 468), 0U);
  EXPECT_EQ(big_at(helios, 469, 2), 1'494U);
  EXPECT_EQ(byte_at(helios, 468 + 48), 0xFFU) << "no more than sixteen lasers";
}

TEST(RobosenseModel, IsDecodedAlikeByItsAnglesInTheStreamAndByItsFile) {
  for (const char* const name : {"rs32", "rs16", "helios16p"}) {
    const auto lidar = make_lidar_model(name);
    const auto decode = [&](const drivers::Calibration& from_file) {
      test::DecoderBench bench(name, {}, 20'000, from_file);
      const std::vector<Echo> echoes(lidar->traits().shots_per_packet, {.range_m = 12.34, .reflectivity = 1});
      for (int i = -2; i < 20; ++i) {
        const std::int64_t utc_ns = kFullHour_utc_ns + 1'000'000 + i * lidar->traits().packet_ns;
        const auto payload =
            i == -1 ? lidar->encode_telemetry({.utc_ns = utc_ns}) : lidar->encode(0, utc_ns, echoes);
        const auto status = bench.decode(payload, utc_ns + lidar->traits().packet_ns).status;
        const bool waits = i == -2 && std::holds_alternative<std::monostate>(from_file);
        EXPECT_EQ(status, waits     ? drivers::DecodeStatus::uncalibrated
                          : i == -1 ? drivers::DecodeStatus::telemetry
                                    : drivers::DecodeStatus::decoded)
            << name << i;
        if (i == -1) static_cast<void>(bench.flush());
      }
      return std::vector<drivers::Point>(bench.points().begin(), bench.points().end());
    };
    const auto by_file = decode(test::calibration_of(*lidar));
    const auto in_stream = decode({});
    ASSERT_EQ(by_file.size(), 20U * 384U) << name;
    ASSERT_EQ(in_stream.size(), by_file.size());
    for (std::size_t i = 0; i < by_file.size(); ++i) {
      ASSERT_NEAR(in_stream[i].x, by_file[i].x, 1e-5) << name;
      ASSERT_NEAR(in_stream[i].y, by_file[i].y, 1e-5) << name;
      ASSERT_NEAR(in_stream[i].z, by_file[i].z, 1e-5) << name;
      ASSERT_EQ(in_stream[i].ring, by_file[i].ring) << name;
    }
  }
}

}  // namespace
}  // namespace landfix::tools::simulator
