// Ouster's units, packets and metadata against the documentation. Independent checks of the same layouts and
// angles: packets that real sensors sent (test/real/os1_real_test.cpp), the check value of the checksum
// (test/drivers/crc64_test.cpp), the design angles of the first generation, and the sizes that the
// documentation lists.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/decoder_bench.hpp"
#include "support/lidar_model_probe.hpp"
#include "tools/simulator/ouster_packets.hpp"
#include "tools/simulator/ouster_units.hpp"

namespace landfix::tools::simulator {
namespace {

using test::kFullHour_utc_ns;
using test::little_at;
using test::shots_at;

constexpr double kRadians_per_deg = std::numbers::pi / 180.0;

TEST(OusterUnits, PointTheirBeamsAsTheFamiliesDo) {
  for (const ouster::Unit& unit : ouster::units()) {
    SCOPED_TRACE(unit.name);
    const auto beams = ouster::beams_of(unit);
    ASSERT_EQ(beams.size(), unit.beams);
    const double spacing_deg = 2.0 * unit.half_field_deg / static_cast<double>(unit.beams - 1);
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const double designed_deg = unit.half_field_deg - spacing_deg * static_cast<double>(i);
      EXPECT_NEAR(beams[i].altitude_deg, designed_deg, 0.2 * spacing_deg + 0.12) << i;
      constexpr double kColumns[] = {1.5, 0.5, -0.5, -1.5};
      EXPECT_NEAR(beams[i].azimuth_deg, unit.azimuth_step_deg * kColumns[i % 4], 0.35) << i;
      if (i > 0) {
        EXPECT_LT(beams[i].altitude_deg, beams[i - 1].altitude_deg);
      }
    }
  }
}

TEST(OusterModel, TurnsClockwiseFromTheBackInStepWithTheTenthsOfASecond) {
  for (const ouster::Unit& unit : ouster::units()) {
    SCOPED_TRACE(unit.name);
    const auto model = make_lidar_model(unit.name);
    const double azimuth_deg = ouster::beams_of(unit)[0].azimuth_deg;
    for (int eighth = 0; eighth < 8; ++eighth) {
      const Shot shot = shots_at(*model, kFullHour_utc_ns + eighth * std::int64_t{12'500'000})[0];
      EXPECT_NEAR(std::remainder(shot.azimuth_deg - (180.0 + 45.0 * eighth + azimuth_deg), 360.0), 0.0, 1e-9);
      // Beams start where the encoder points, at the height of the optical plane.
      const double turned_rad = (180.0 + 45.0 * eighth) * kRadians_per_deg;
      EXPECT_NEAR(shot.origin_m.x(), 1e-3 * unit.beam_origin_mm * std::cos(turned_rad), 1e-12);
      EXPECT_NEAR(shot.origin_m.y(), -1e-3 * unit.beam_origin_mm * std::sin(turned_rad), 1e-12);
      EXPECT_NEAR(shot.origin_m.z(), 1e-3 * unit.lift_mm, 1e-12);
    }
    EXPECT_EQ(100'000'000 % model->traits().packet_ns, 0) << "a turn is so many packets";
  }
}

TEST(OusterPackets, HaveTheSizesOfTheDocumentation) {
  struct Size {
    ouster::Profile profile;
    std::size_t bytes[4];  ///< for 16, 32, 64, 128 rows
  };
  using enum ouster::Profile;
  constexpr Size kSizes[] = {{legacy, {3392, 6464, 12608, 24896}},
                             {single, {3328, 6400, 12544, 24832}},
                             {single_zones, {3328, 6400, 12544, 24832}},
                             {dual, {4352, 8448, 16640, 33024}},
                             {dual_zones, {4352, 8448, 16640, 33024}},
                             {single_colour, {4352, 8448, 16640, 33024}},
                             {low_rate, {1280, 2304, 4352, 8448}},
                             {low_rate_window, {1280, 2304, 4352, 8448}},
                             {low_rate_dual_fusa, {2304, 4352, 8448, 16640}},
                             {low_rate_dual, {2304, 4352, 8448, 16640}},
                             {low_rate_zones, {2304, 4352, 8448, 16640}},
                             {five_words, {5376, 10496, 20736, 41216}},
                             {dual_colour, {5376, 10496, 20736, 41216}}};
  static_assert(std::size(kSizes) == ouster::kProfileCount);
  for (const Size& size : kSizes) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t rows = 16U << i;
      const auto packet = ouster::lidar_packet({.profile = size.profile, .rows = rows}, {},
                                               std::vector<Echo>(ouster::kColumnsPerPacket * rows));
      EXPECT_EQ(packet.size(), size.bytes[i]) << name_of(size.profile) << ", " << rows;
    }
  }
}

TEST(OusterPackets, PutEveryHeaderFieldWhereTheDocumentationSays) {
  const std::vector<Echo> echoes(std::size_t{16} * 128);
  const ouster::PacketMoment moment{
      .frame_id = 1795, .first_column = 112, .utc_ns = 0x0123'4567'89AB'CDEF, .column_ns = 97'656};
  ouster::PacketFormat format{.profile = ouster::Profile::low_rate,
                              .rows = 128,
                              .serial_number = 122'201'000'998,
                              .init_id = 7'109'750};
  const auto standard = lidar_packet(format, moment, echoes);
  EXPECT_EQ(little_at(standard, 0, 2), 1U);
  EXPECT_EQ(little_at(standard, 2, 2), 1795U);
  EXPECT_EQ(little_at(standard, 4, 3), 7'109'750U);
  EXPECT_EQ(little_at(standard, 7, 5), 122'201'000'998U);
  EXPECT_EQ(little_at(standard, 12, 8), 0U);
  const std::size_t second = 32 + 12 + 4 * 128;
  EXPECT_EQ(little_at(standard, second, 8), 0x0123'4567'89AB'CDEFU + 97'656U);
  EXPECT_EQ(little_at(standard, second + 8, 2), 113U);
  EXPECT_EQ(little_at(standard, second + 10, 2), 1U);
  EXPECT_EQ(little_at(standard, standard.size() - 32, 8), 0U);
  EXPECT_NE(little_at(standard, standard.size() - 8, 8), 0U);

  format.fusa_header = true;
  format.checksum = false;
  const auto fusa = lidar_packet(format, moment, echoes);
  EXPECT_EQ(little_at(fusa, 0, 1), 1U);
  EXPECT_EQ(little_at(fusa, 1, 3), 7'109'750U);
  EXPECT_EQ(little_at(fusa, 4, 4), 1795U);
  EXPECT_EQ(little_at(fusa, 11, 5), 122'201'000'998U);
  EXPECT_EQ(little_at(fusa, fusa.size() - 8, 8), 0U);

  format = {.profile = ouster::Profile::legacy, .rows = 64, .columns_per_turn = 512};
  const auto legacy = lidar_packet(format, moment, echoes);
  EXPECT_EQ(little_at(legacy, 788, 8), 0x0123'4567'89AB'CDEFU + 97'656U);
  EXPECT_EQ(little_at(legacy, 788 + 8, 2), 113U);
  EXPECT_EQ(little_at(legacy, 788 + 10, 2), 1795U);
  EXPECT_EQ(little_at(legacy, 788 + 12, 4), 113U * 176U);
  EXPECT_EQ(little_at(legacy, 788 + 784, 4), 0xFFFF'FFFFU);
}

TEST(OusterModel, SendsWhatItsImuSays) {
  const auto old = make_lidar_model("os1-64")->encode_telemetry({.utc_ns = kFullHour_utc_ns});
  ASSERT_EQ(old.size(), 48U);
  EXPECT_EQ(little_at(old, 8, 8), static_cast<std::uint64_t>(kFullHour_utc_ns));
  EXPECT_EQ(little_at(old, 32, 4), 0x3F80'0000U) << "1 g upwards";
  const auto recent = make_lidar_model("os1-128")->encode_telemetry({.utc_ns = kFullHour_utc_ns});
  ASSERT_EQ(recent.size(), 308U);
  EXPECT_EQ(little_at(recent, 0, 2), 2U);
}

TEST(OusterModel, GivesOutItsMetadataInBothLayouts) {
  const auto flat = nlohmann::json::parse(make_lidar_model("os1-64")->calibration()->text);
  EXPECT_EQ(flat.at("beam_altitude_angles").at(0), 16.729);
  EXPECT_EQ(flat.at("data_format").at("udp_profile_lidar"), "LEGACY");
  const auto old = nlohmann::json::parse(make_lidar_model("os1-16")->calibration()->text);
  EXPECT_EQ(old.at("beam_altitude_angles").size(), 64U);
  EXPECT_EQ(old.at("beam_altitude_angles").at(2), 0.0);
  const auto nested = nlohmann::json::parse(make_lidar_model("os2-128")->calibration()->text);
  EXPECT_EQ(nested.at("beam_intrinsics").at("beam_azimuth_angles").size(), 128U);
  EXPECT_EQ(nested.at("lidar_data_format").at("header_type"), "FUSA");
  EXPECT_EQ(nested.at("lidar_intrinsics").at("lidar_to_sensor_transform").at(11), 78.296);
}

/// Every profile with either header, both returns where it has them: there, and back by the decoder.
class EveryProfile : public testing::TestWithParam<std::tuple<std::size_t, bool>> {};

TEST_P(EveryProfile, ComesBackFromTheDecoder) {
  const auto [index, fusa] = GetParam();
  const auto profile = static_cast<ouster::Profile>(index);
  constexpr std::size_t kRows = 32;
  constexpr std::size_t kColumns = 2048;
  const double unit_m =
      std::string_view(name_of(profile)).find("RNG15") != std::string_view::npos ? 0.008 : 0.001;

  nlohmann::json metadata{{"lidar_mode", "2048x10"}};
  metadata["data_format"] = {{"udp_profile_lidar", name_of(profile)},
                             {"header_type", fusa ? "FUSA" : "STANDARD"}};
  std::vector<double> altitudes_deg;
  for (std::size_t i = 0; i < kRows; ++i) altitudes_deg.push_back(10.0 - static_cast<double>(i));
  metadata["beam_altitude_angles"] = altitudes_deg;
  metadata["beam_azimuth_angles"] = std::vector<double>(kRows, 0.0);
  metadata["lidar_origin_to_beam_origin_mm"] = 0.0;
  metadata["lidar_to_sensor_transform"] = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const std::string text = metadata.dump();
  const auto& model = *drivers::find_sensor_model("os1-32");
  test::DecoderBench bench(
      model.name, {}, 200'000,
      drivers::parse_calibration(model, std::as_bytes(std::span(text)), "metadata.json"));

  const ouster::PacketFormat format{.profile = profile,
                                    .fusa_header = fusa || profile == ouster::Profile::low_rate_dual_fusa,
                                    .checksum = !fusa,
                                    .rows = kRows,
                                    .columns_per_turn = kColumns,
                                    .serial_number = 991'913'000'010,
                                    .init_id = 390'076};
  const bool dual = has_second_return(profile);
  struct Sent {
    Echo echo{};
    std::size_t row = 0;
    std::int64_t after_ns = 0;
  };
  std::vector<Sent> sent;
  constexpr std::int64_t kColumn_ns = 48'828;
  const std::size_t packets = kColumns / ouster::kColumnsPerPacket;
  for (std::size_t p = 0; p < packets; ++p) {
    std::vector<Echo> first(16 * kRows);
    std::vector<Echo> second(16 * kRows);
    const std::int64_t after_ns = static_cast<std::int64_t>(p) * 16 * kColumn_ns;
    for (std::size_t i = 0; i < first.size(); ++i) {
      const std::size_t n = p * first.size() + i;
      const auto bright = static_cast<std::uint8_t>(n % 251);
      if (n % 5 != 0)
        first[i] = {.range_m = 1.0 + 0.0013 * static_cast<double>(n % 150'000), .reflectivity = bright};
      if (n % 3 == 0)
        second[i] = {.range_m = 2.0 + 0.0017 * static_cast<double>(n % 130'000), .reflectivity = 7};
      if (n % 7 == 0) second[i] = first[i];  // one echo, reported twice
      const Sent at{.row = i % kRows,
                    .after_ns = after_ns + static_cast<std::int64_t>(i / kRows) * kColumn_ns};
      const auto raw = [&](const Echo& echo) { return std::round(echo.range_m / unit_m); };
      if (first[i].range_m > 0.0) sent.push_back({first[i], at.row, at.after_ns});
      if (dual && second[i].range_m > 0.0 && raw(second[i]) != raw(first[i])) {
        sent.push_back({second[i], at.row, at.after_ns});
      }
    }
    const auto payload = lidar_packet(format,
                                      {.frame_id = fusa ? 70'000U : 7U,
                                       .first_column = 16 * p,
                                       .utc_ns = kFullHour_utc_ns + after_ns,
                                       .column_ns = kColumn_ns},
                                      first, dual ? std::span<const Echo>(second) : std::span<const Echo>());
    EXPECT_TRUE(drivers::looks_like(model, payload));
    const auto result = bench.decode(payload, kFullHour_utc_ns + after_ns + 1'000'000);
    ASSERT_EQ(result.status, drivers::DecodeStatus::decoded) << to_string(result.status);
  }
  ASSERT_EQ(bench.swept().size(), 1U) << "by the last packet of the frame";
  EXPECT_TRUE(bench.swept()[0].complete);
  const auto& points = bench.swept()[0].points;
  ASSERT_EQ(points.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const drivers::Point& point = points[i];
    ASSERT_NEAR(std::hypot(point.x, point.y, point.z), sent[i].echo.range_m, 0.5 * unit_m + 1e-4) << i;
    ASSERT_EQ(point.intensity, static_cast<float>(sent[i].echo.reflectivity)) << i;
    ASSERT_EQ(point.ring, kRows - 1 - sent[i].row) << i;
    ASSERT_NEAR(point.time_s, 1e-9 * static_cast<double>(sent[i].after_ns), 1e-8) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(AndHeader, EveryProfile,
                         testing::Combine(testing::Range(std::size_t{0}, ouster::kProfileCount),
                                          testing::Bool()),
                         [](const auto& parameters) {
                           const auto profile = static_cast<ouster::Profile>(std::get<0>(parameters.param));
                           return std::string(name_of(profile)) +
                                  (std::get<1>(parameters.param) ? "_fusa" : "");
                         });

}  // namespace
}  // namespace landfix::tools::simulator
