// The VLP-16's tables and bytes against the manual. Independent checks of the same tables: the vendor's
// viewer and a driver of others on recorded packets (test/real/vlp16_real_test.cpp).
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/lidar_model_probe.hpp"

namespace landfix::tools::simulator {
namespace {

using test::byte_at;
using test::kFullHour_utc_ns;
using test::little_at;
using test::shots_at;

TEST(Vlp16Model, BeamsCrossAboutFortyTwoMillimetresOut) {
  // The offsets come from a drawing in which all beams pass one point: another way to the same table.
  const auto shots = shots_at("vlp16", kFullHour_utc_ns);
  for (std::size_t laser = 0; laser < 16; ++laser) {
    const double elevation_deg =
        laser % 2 == 0 ? -15.0 + static_cast<double>(laser) : static_cast<double>(laser);
    EXPECT_DOUBLE_EQ(shots[laser].elevation_deg, elevation_deg);
    EXPECT_NEAR(1e3 * shots[laser].origin_m.z(), -41.8 * std::tan(elevation_deg * std::numbers::pi / 180.0),
                0.06);
  }
}

TEST(Vlp16Model, TheHiResBeamsAreTwoThirdsAsSteepAndAntisymmetric) {
  const auto puck = shots_at("vlp16", kFullHour_utc_ns);
  const auto hi_res = shots_at("vlp16hires", kFullHour_utc_ns);
  for (std::size_t laser = 0; laser < 16; ++laser) {
    EXPECT_NEAR(hi_res[laser].elevation_deg, puck[laser].elevation_deg * 2.0 / 3.0, 1e-9);
    EXPECT_DOUBLE_EQ(hi_res[laser].origin_m.z(), -hi_res[15 - laser].origin_m.z());
  }
}

TEST(Vlp16Model, FiresAsTheManualTimesIt) {
  const auto model = make_lidar_model("vlp16");
  const auto shots = shots_at(*model, kFullHour_utc_ns);
  ASSERT_EQ(shots.size(), 384U);
  EXPECT_EQ(shots[0].after_ns, 0);
  EXPECT_EQ(shots[1].after_ns, 2'304);
  EXPECT_EQ(shots[15].after_ns, 34'560);
  EXPECT_EQ(shots[16].after_ns, 55'296);
  EXPECT_EQ(shots[31].after_ns, 89'856);
  EXPECT_EQ(shots[32].after_ns, 110'592);
  EXPECT_EQ(shots[383].after_ns, 11 * 110'592 + 89'856);
  EXPECT_EQ(model->traits().packet_ns, 1'327'104);
}

TEST(Vlp16Model, ReturnsLieWhereTheManualsArithmeticPutsThem) {
  struct Example {
    std::size_t shot;
    std::int64_t block_ns;  // at which the rotor shows the example's azimuth
    double range_m;
    Eigen::Vector3d point_m;
  };
  const Example examples[] = {{1, 27'777'778, 10.000, {-1.7376, -9.8463, 0.1738}},
                              {31, 99'972'222, 24.690, {23.8485, -0.0930, 6.3790}}};
  for (const Example& example : examples) {
    const Shot shot = shots_at("vlp16", kFullHour_utc_ns + example.block_ns)[example.shot];
    const Eigen::Vector3d point_m = shot.origin_m + example.range_m * shot.direction();
    EXPECT_LT((point_m - example.point_m).cwiseAbs().maxCoeff(), 1e-4) << example.shot;
  }
}

TEST(RotorAngle, TurnsTenTimesASecondClockwise) {
  EXPECT_DOUBLE_EQ(rotor_angle_deg(kFullHour_utc_ns), 0.0);
  EXPECT_DOUBLE_EQ(rotor_angle_deg(kFullHour_utc_ns + 25'000'000), 90.0);
  EXPECT_DOUBLE_EQ(rotor_angle_deg(kFullHour_utc_ns + 100'000'000), 0.0);
  EXPECT_LT((Shot{.azimuth_deg = 90.0}.direction().y()), -0.999);  // a quarter turn looks to the right
  for (std::int64_t ns = 99'990'000; ns < 100'010'000; ns += 500) {
    ASSERT_LT(rotor_angle_centideg(kFullHour_utc_ns + ns), 36000);
  }
}

TEST(Vlp16Model, PutsEveryFieldWhereTheManualSays) {
  const auto model = make_lidar_model("vlp16");
  std::vector<Echo> echoes(384);
  echoes[0] = {.range_m = 0xABCD * 0.002 + 0.0009, .reflectivity = 0x5A};
  echoes[383] = {.range_m = 0x0102 * 0.002 - 0.0009, .reflectivity = 0xFF};
  const std::int64_t after_hour_us = 0x0123'4567;
  const auto payload = model->encode(0, kFullHour_utc_ns + after_hour_us * 1000 + 999, echoes);
  ASSERT_EQ(payload.size(), 1206U);
  for (std::size_t block = 0; block < 12; ++block) {
    EXPECT_EQ(byte_at(payload, 100 * block), 0xFFU);
    EXPECT_EQ(byte_at(payload, 100 * block + 1), 0xEEU);
    const double turned_us =
        static_cast<double>(after_hour_us) + 0.999 + 110.592 * static_cast<double>(block);
    const std::uint64_t azimuth = little_at(payload, 100 * block + 2, 2);
    EXPECT_NEAR(static_cast<double>(azimuth), std::fmod(0.36 * turned_us, 36000.0), 0.501) << block;
  }
  EXPECT_EQ(byte_at(payload, 4), 0xCDU);
  EXPECT_EQ(byte_at(payload, 5), 0xABU);
  EXPECT_EQ(byte_at(payload, 6), 0x5AU);
  EXPECT_EQ(byte_at(payload, 1197), 0x02U);
  EXPECT_EQ(byte_at(payload, 1198), 0x01U);
  EXPECT_EQ(byte_at(payload, 1199), 0xFFU);
  EXPECT_EQ(byte_at(payload, 1200), 0x67U);
  EXPECT_EQ(byte_at(payload, 1201), 0x45U);
  EXPECT_EQ(byte_at(payload, 1202), 0x23U);
  EXPECT_EQ(byte_at(payload, 1203), 0x01U);
  EXPECT_EQ(byte_at(payload, 1204), 0x37U);
  EXPECT_EQ(byte_at(payload, 1205), 0x22U);
  EXPECT_EQ(byte_at(make_lidar_model("vlp16hires")->encode(0, kFullHour_utc_ns, echoes), 1205), 0x24U);
}

TEST(VelodynePositionPacket, CarriesTimePulseAndACheckedSentence) {
  const auto payload = make_lidar_model("vlp16")->encode_telemetry({.utc_ns = 1'777'882'501'000'000'000,
                                                                    .latitude_deg = 48.1173,
                                                                    .longitude_deg = -11.5,
                                                                    .speed_mps = 10.0,
                                                                    .course_deg = 90.0});
  ASSERT_EQ(payload.size(), 512U);
  EXPECT_EQ(little_at(payload, 198, 4), 901'000'000U);  // 08:15:01
  EXPECT_EQ(byte_at(payload, 202), 2U);
  std::string sentence;
  for (std::size_t at = 206; byte_at(payload, at) != 0; ++at)
    sentence += static_cast<char>(byte_at(payload, at));
  const std::string body = "GPRMC,081501,A,4807.0380,N,01130.0000,W,019.4,090.0,040526,,,A";
  ASSERT_EQ(sentence.substr(0, body.size() + 2), "$" + body + "*");
  unsigned checksum = 0;
  for (const char c : body) checksum ^= static_cast<unsigned char>(c);
  EXPECT_EQ(std::stoul(sentence.substr(body.size() + 2, 2), nullptr, 16), checksum);
  EXPECT_EQ(sentence.substr(body.size() + 4), "\r\n");
}

}  // namespace
}  // namespace landfix::tools::simulator
