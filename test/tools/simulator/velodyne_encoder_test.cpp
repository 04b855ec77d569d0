#include "tools/simulator/velodyne_encoder.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace landfix::tools::simulator {
namespace {

unsigned byte_at(const auto& payload, std::size_t at) { return std::to_integer<unsigned>(payload[at]); }

TEST(Vlp16, BeamsCrossAboutFortyTwoMillimetresOut) {
  // The offsets come from a drawing in which all beams pass one point: another way to the same table.
  for (std::size_t laser = 0; laser < vlp16::kLasers; ++laser) {
    const double elevation_deg =
        laser % 2 == 0 ? -15.0 + static_cast<double>(laser) : static_cast<double>(laser);
    EXPECT_DOUBLE_EQ(vlp16::kBeams[laser].elevation_deg, elevation_deg);
    EXPECT_NEAR(vlp16::kBeams[laser].vertical_offset_mm,
                -41.8 * std::tan(elevation_deg * std::numbers::pi / 180.0), 0.06);
  }
}

TEST(Vlp16, FiresAsTheManualTimesIt) {
  EXPECT_EQ(vlp16::firing_time_ns(0), 0);
  EXPECT_EQ(vlp16::firing_time_ns(1), 2'304);
  EXPECT_EQ(vlp16::firing_time_ns(15), 34'560);
  EXPECT_EQ(vlp16::firing_time_ns(16), 55'296);
  EXPECT_EQ(vlp16::firing_time_ns(31), 89'856);
  EXPECT_EQ(vlp16::firing_time_ns(32), 110'592);
  EXPECT_EQ(vlp16::firing_time_ns(383), 11 * 110'592 + 89'856);
  EXPECT_EQ(vlp16::kPacket_ns, 1'327'104);
}

TEST(Vlp16, ReturnsLieWhereTheManualsArithmeticPutsThem) {
  struct Example {
    std::size_t firing;
    double block_azimuth_deg;
    int distance_raw;
    Eigen::Vector3d point_m;
  };
  const Example examples[] = {{1, 100.00, 5000, {-1.7376, -9.8463, 0.1738}},
                              {31, 359.90, 12345, {23.8485, -0.0930, 6.3790}}};
  for (const Example& example : examples) {
    const vlp16::Beam& beam = vlp16::kBeams[example.firing % vlp16::kLasers];
    const double azimuth_deg = example.block_azimuth_deg +
                               3600.0 * 1e-9 * static_cast<double>(vlp16::firing_time_ns(example.firing));
    const Eigen::Vector3d point_m = vlp16::beam_origin_m(beam) + example.distance_raw *
                                                                     vlp16::kDistanceUnit_m *
                                                                     vlp16::beam_direction(beam, azimuth_deg);
    EXPECT_LT((point_m - example.point_m).cwiseAbs().maxCoeff(), 1e-4) << example.firing;
  }
}

TEST(Vlp16, TheRotorTurnsTenTimesASecondClockwise) {
  EXPECT_DOUBLE_EQ(vlp16::rotor_angle_deg(1'777'882'500'000'000'000), 0.0);
  EXPECT_DOUBLE_EQ(vlp16::rotor_angle_deg(1'777'882'500'025'000'000), 90.0);
  EXPECT_DOUBLE_EQ(vlp16::rotor_angle_deg(1'777'882'500'100'000'000), 0.0);
  EXPECT_LT(vlp16::beam_direction({}, 90.0).y(), -0.999);  // a quarter turn looks to the right
}

TEST(VelodyneEncoder, PutsEveryFieldWhereTheManualSays) {
  Vlp16Firings firings;
  firings.first_firing_utc_ns = 1'777'881'600'000'000'000 + 0x0123'4567 * std::int64_t{1000} + 999;
  firings.azimuth_centideg_raw[0] = 35999;
  firings.azimuth_centideg_raw[11] = 0x1234;
  firings.returns[0] = {.distance_raw = 0xABCD, .reflectivity_raw = 0x5A};
  firings.returns[383] = {.distance_raw = 0x0102, .reflectivity_raw = 0xFF};
  const DataPayload payload = encode_data(firings);
  for (std::size_t block = 0; block < 12; ++block) {
    EXPECT_EQ(byte_at(payload, 100 * block), 0xFFU);
    EXPECT_EQ(byte_at(payload, 100 * block + 1), 0xEEU);
  }
  EXPECT_EQ(byte_at(payload, 2), 0x9FU);
  EXPECT_EQ(byte_at(payload, 3), 0x8CU);
  EXPECT_EQ(byte_at(payload, 1102), 0x34U);
  EXPECT_EQ(byte_at(payload, 1103), 0x12U);
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
}

TEST(VelodyneEncoder, PositionPacketsCarryTimePulseAndACheckedSentence) {
  const PositionPayload payload = encode_position({.utc_ns = 1'777'882'501'000'000'000,
                                                   .latitude_deg = 48.1173,
                                                   .longitude_deg = -11.5,
                                                   .speed_mps = 10.0,
                                                   .course_deg = 90.0});
  const unsigned time_us = byte_at(payload, 198) | byte_at(payload, 199) << 8 | byte_at(payload, 200) << 16 |
                           byte_at(payload, 201) << 24;
  EXPECT_EQ(time_us, 901'000'000U);  // 08:15:01
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
