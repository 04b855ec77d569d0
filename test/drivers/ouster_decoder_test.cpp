#include "drivers/ouster/ouster_decoder.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/decoder_bench.hpp"
#include "support/ouster_packets.hpp"
#include "support/store.hpp"

namespace landfix::drivers {
namespace {

using ouster::HeaderType;
using ouster::Metadata;
using ouster::Profile;
using test::DecoderBench;
using test::ouster_metadata;
using test::OusterPacket;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr std::int64_t kNs = test::kReceiveUtcNs - 2'000'000;  // received 2 ms after the first column

DecoderBench bench_of(const Metadata& metadata, const DecoderOptions& options = {}) {
  const std::string name = "os1-" + std::to_string(metadata.beam_count);
  return DecoderBench(name, options, 100'000, metadata);
}

OusterPacket sound_packet(const Metadata& metadata, std::size_t number = 0) {
  OusterPacket packet(metadata);
  packet.set_place(number, kNs);
  return packet;
}

struct Position {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

TEST(OusterDecoder, PlacesABeamByTheVendorsFormula) {
  // Tilted and turned, so that every element counts; beams start above the optical plane.
  Metadata metadata = ouster_metadata(Profile::single);
  metadata.beam_origin_z_mm = 4.0;
  metadata.lidar_to_sensor = {0.36, 0.48, -0.8, 10, -0.8, 0.6, 0.0, 20, 0.48, 0.64, 0.6, 30, 0, 0, 0, 1};
  auto bench = bench_of(metadata);
  OusterPacket packet = sound_packet(metadata, 7);
  packet.set_return(3, 5, 12'345, 67);
  ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 1U);
  const Point& point = bench.points()[0];

  const double encoder_rad = 2.0 * std::numbers::pi * (1.0 - (7 * 16 + 3) / 1024.0);
  const double azimuth_rad = -metadata.rows[5].azimuth_deg * kRadPerDeg;
  const double altitude_rad = metadata.rows[5].altitude_deg * kRadPerDeg;
  const double along_mm = 12'345 - std::hypot(15.806, 4.0);
  const Position lidar{.x = along_mm * std::cos(encoder_rad + azimuth_rad) * std::cos(altitude_rad) +
                            15.806 * std::cos(encoder_rad),
                       .y = along_mm * std::sin(encoder_rad + azimuth_rad) * std::cos(altitude_rad) +
                            15.806 * std::sin(encoder_rad),
                       .z = along_mm * std::sin(altitude_rad) + 4.0};
  const auto& m = metadata.lidar_to_sensor;
  EXPECT_NEAR(point.x, 1e-3 * (m[0] * lidar.x + m[1] * lidar.y + m[2] * lidar.z + m[3]), 5e-6);
  EXPECT_NEAR(point.y, 1e-3 * (m[4] * lidar.x + m[5] * lidar.y + m[6] * lidar.z + m[7]), 5e-6);
  EXPECT_NEAR(point.z, 1e-3 * (m[8] * lidar.x + m[9] * lidar.y + m[10] * lidar.z + m[11]), 5e-6);
  EXPECT_EQ(point.intensity, 67.0F);
  EXPECT_EQ(point.ring, 63 - 5);
}

TEST(OusterDecoder, GivesWhatTheVendorsSoftwareGivesForADualReturn) {
  // Two pixels that an OS1-64 with firmware 2.5.2 sent, and where the vendor's software placed them.
  struct Golden {
    std::size_t column, row;
    double altitude_deg, azimuth_deg;
    unsigned range_mm, second_range_mm, reflectivity;
    double x, y, z;
  };
  constexpr Golden kGoldens[] = {{511, 31, 10.93, -4.26, 442, 2604, 126, 0.4329, 0.0337, 0.1170},
                                 {496, 63, -0.17, -4.22, 1473, 0, 94, 1.4515, 0.2507, 0.0319}};
  for (const Golden& golden : kGoldens) {
    Metadata metadata = ouster_metadata(Profile::dual);
    metadata.rows[golden.row].altitude_deg = golden.altitude_deg;
    metadata.rows[golden.row].azimuth_deg = golden.azimuth_deg;
    OusterPacket packet = sound_packet(metadata, golden.column / 16);
    packet.set_return(golden.column % 16, golden.row, golden.range_mm, golden.reflectivity);
    packet.set_return(golden.column % 16, golden.row, golden.second_range_mm, 1, 1);
    auto bench = bench_of(metadata);
    ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
    ASSERT_EQ(bench.points().size(), golden.second_range_mm == 0 ? 1U : 2U);
    const Point& point = bench.points()[0];
    EXPECT_NEAR(point.x, golden.x, 6e-5);
    EXPECT_NEAR(point.y, golden.y, 6e-5);
    EXPECT_NEAR(point.z, golden.z, 6e-5);
    EXPECT_EQ(point.intensity, static_cast<float>(golden.reflectivity));
  }
}

TEST(OusterHeader, IsReadInBothForms) {
  // Of recorded packets; every byte between the fields is set.
  std::vector<std::byte> standard(32, std::byte{0xFF});
  test::store(standard.data(), 1, 2);
  test::store(standard.data() + 2, 1795, 2);
  test::store(standard.data() + 4, 7'109'750, 3);
  test::store(standard.data() + 7, 122'201'000'998, 5);
  auto header = ouster::read_header(standard.data(), HeaderType::standard);
  EXPECT_EQ(header.type, 1U);
  EXPECT_EQ(header.frame_id, 1795U);
  EXPECT_EQ(header.init_id, 7'109'750U);
  EXPECT_EQ(header.serial_number, 122'201'000'998U);
  std::vector<std::byte> fusa(32, std::byte{0xFF});
  test::store(fusa.data(), 1, 1);
  test::store(fusa.data() + 1, 390'076, 3);
  test::store(fusa.data() + 4, 229, 4);
  test::store(fusa.data() + 11, 122'246'000'293, 5);
  header = ouster::read_header(fusa.data(), HeaderType::fusa);
  EXPECT_EQ(header.type, 1U);
  EXPECT_EQ(header.frame_id, 229U);
  EXPECT_EQ(header.init_id, 390'076U);
  EXPECT_EQ(header.serial_number, 122'246'000'293U);
}

TEST(OusterDecoder, TurnsClockwiseFromTheConnectorAtTheBack) {
  Metadata metadata = ouster_metadata(Profile::legacy);
  for (ouster::Row& row : metadata.rows) row.azimuth_deg = row.altitude_deg = 0.0;
  const Position directions[] = {
      {.x = -1.0}, {.y = 1.0}, {.x = 1.0}, {.y = -1.0}};  // back, left, front, right
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    auto bench = bench_of(metadata);
    OusterPacket packet = sound_packet(metadata, quarter * 16);
    packet.set_return(0, 0, 10'000);
    ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
    ASSERT_EQ(bench.points().size(), 1U);
    EXPECT_NEAR(bench.points()[0].x, 10.0 * directions[quarter].x, 1e-5);
    EXPECT_NEAR(bench.points()[0].y, 10.0 * directions[quarter].y, 1e-5);
    EXPECT_NEAR(bench.points()[0].z, 0.03618, 1e-6);
  }
}

TEST(OusterDecoder, ReadsThePixelsOfEveryProfile) {
  struct Example {
    const char* profile;
    std::vector<unsigned> pixel;  ///< every bit that is none of range or reflectivity is set
    std::vector<unsigned> ranges_mm;
    std::vector<unsigned> reflectivities;
  };
  // Range 0x345678 without what does not fit; reflectivity 0xA1, second return 0x23456 or 0x2345, 0xB2.
  const Example examples[] = {
      {"LEGACY", {0x78, 0x56, 0xF4, 0xFF, 0xA1, 0xFF, 255, 255, 255, 255, 255, 255}, {0x45678}, {0xA1}},
      {"RNG19_RFL8_SIG16_NIR16",
       {0x78, 0x56, 0xFC, 0xFF, 0xA1, 0xFF, 255, 255, 255, 255, 255, 255},
       {0x45678},
       {0xA1}},
      {"RNG19_RFL8_SIG16_NIR16_ZONE16",
       {0x78, 0x56, 0xFC, 0xFF, 0xA1, 0xFF, 255, 255, 255, 255, 255, 255},
       {0x45678},
       {0xA1}},
      {"RNG19_RFL8_SIG16_NIR16_DUAL",
       {0x78, 0x56, 0xFC, 0xA1, 0x56, 0x34, 0xFA, 0xB2, 255, 255, 255, 255, 255, 255, 255, 255},
       {0x45678, 0x23456},
       {0xA1, 0xB2}},
      {"RNG19_RFL8_SIG16_ZONE16_DUAL",
       {0x78, 0x56, 0xFC, 0xA1, 0x56, 0x34, 0xFA, 0xB2, 255, 255, 255, 255, 255, 255, 255, 255},
       {0x45678, 0x23456},
       {0xA1, 0xB2}},
      {"RNG15_RFL8_NIR8", {0x78, 0xD6, 0xA1, 0xFF}, {0x5678 * 8}, {0xA1}},
      {"RNG15_RFL8_WIN8", {0x78, 0xD6, 0xA1, 0xFF}, {0x5678 * 8}, {0xA1}},
      {"RNG15_RFL8_NIR8_ZONE16", {0x78, 0xD6, 0xA1, 255, 255, 255, 255, 255}, {0x5678 * 8}, {0xA1}},
      {"RNG15_RFL8_NIR8_DUAL",
       {0x78, 0xD6, 0xA1, 0xFF, 0x45, 0xA3, 0xB2, 0xFF},
       {0x5678 * 8, 0x2345 * 8},
       {0xA1, 0xB2}},
      {"FUSA_RNG15_RFL8_NIR8_DUAL",
       {0x78, 0xD6, 0xA1, 0xFF, 0x45, 0xA3, 0xB2, 0xFF},
       {0x5678 * 8, 0x2345 * 8},
       {0xA1, 0xB2}},
      {"FIVE_WORD_PIXEL",
       {0x78, 0x56, 0xFC, 0xA1, 0x56, 0x34, 0xFA, 0xB2, 255, 255,
        255,  255,  255,  255,  255,  255,  255,  255,  255, 255},
       {0x45678, 0x23456},
       {0xA1, 0xB2}},
      {"RNG19_RFL8_SIG16_NIR16_RGB16",
       {0x78, 0x56, 0xFC, 0xA1, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255},
       {0x45678},
       {0xA1}},
      {"RNG19_RFL8_SIG16_NIR16_RGB16_DUAL",
       {0x78, 0x56, 0xFC, 0xA1, 0x56, 0x34, 0xFA, 0xB2, 255, 255,
        255,  255,  255,  255,  255,  255,  255,  255,  255, 255},
       {0x45678, 0x23456},
       {0xA1, 0xB2}},
  };
  ASSERT_EQ(std::size(examples), ouster::kProfiles.size());
  for (const Example& example : examples) {
    SCOPED_TRACE(example.profile);
    const auto* const row = std::ranges::find(ouster::kProfiles, example.profile, &ouster::ProfileRow::name);
    ASSERT_NE(row, ouster::kProfiles.end());
    ASSERT_EQ(row->pixel.bytes, example.pixel.size());
    Metadata metadata = ouster_metadata(static_cast<Profile>(row - ouster::kProfiles.begin()));
    metadata.beam_origin_x_mm = 0.0;
    metadata.lidar_to_sensor[11] = 0.0;
    auto bench = bench_of(metadata);
    OusterPacket packet = sound_packet(metadata);
    for (std::size_t i = 0; i < example.pixel.size(); ++i)
      packet.set(packet.pixel_at(2, 9) + i, example.pixel[i], 1);
    ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
    ASSERT_EQ(bench.points().size(), example.ranges_mm.size());
    for (std::size_t k = 0; k < example.ranges_mm.size(); ++k) {
      const Point& point = bench.points()[k];
      EXPECT_NEAR(std::hypot(point.x, point.y, point.z), 1e-3 * example.ranges_mm[k], 2e-4);
      EXPECT_EQ(point.intensity, static_cast<float>(example.reflectivities[k]));
      EXPECT_EQ(point.ring, 63 - 9);
    }
  }
}

TEST(OusterDecoder, KnowsTheSizesOfTheManual) {
  struct Size {
    Profile profile;
    std::size_t rows[4];  ///< bytes for 16, 32, 64, 128
  };
  constexpr Size kSizes[] = {{Profile::legacy, {3392, 6464, 12608, 24896}},
                             {Profile::single, {3328, 6400, 12544, 24832}},
                             {Profile::dual, {4352, 8448, 16640, 33024}},
                             {Profile::low_rate, {1280, 2304, 4352, 8448}},
                             {Profile::low_rate_dual, {2304, 4352, 8448, 16640}},
                             {Profile::five_words, {5376, 10496, 20736, 41216}}};
  for (const Size& size : kSizes) {
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(ouster::packet_shape(size.profile, 16U << i, 16).packet_bytes, size.rows[i]);
    }
  }
}

TEST(OusterDecoder, DropsSecondReturnsEqualToTheFirstAndRangesThatAreNotAskedFor) {
  const Metadata metadata = ouster_metadata(Profile::dual);
  auto bench = bench_of(metadata, {.min_range_m = 2.0, .max_range_m = 5.0});
  OusterPacket packet = sound_packet(metadata);
  packet.set_return(0, 0, 3000, 1);
  packet.set_return(0, 0, 3000, 2, 1);  // equal
  packet.set_return(0, 1, 3000, 3);
  packet.set_return(0, 1, 4000, 4, 1);  // both
  packet.set_return(0, 2, 0, 5);
  packet.set_return(0, 2, 4000, 6, 1);  // only the second
  packet.set_return(0, 3, 1999, 7);
  packet.set_return(0, 3, 5001, 8, 1);  // neither
  packet.set_return(1, 0, 2000, 9);
  packet.set_return(1, 0, 5000, 10, 1);  // both, just
  packet.set_return(1, 1, 0, 255);       // no range: whatever else is there
  ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
  std::vector<float> intensities;
  for (const Point& point : bench.points()) intensities.push_back(point.intensity);
  EXPECT_EQ(intensities, (std::vector<float>{1, 3, 4, 6, 9, 10}));
}

TEST(OusterDecoder, TimesEachColumnByItsOwnStamp) {
  const Metadata metadata = ouster_metadata(Profile::legacy);
  auto bench = bench_of(metadata);
  OusterPacket packet = sound_packet(metadata);
  packet.set_time(1, static_cast<std::uint64_t>(kNs + 84'000));
  packet.set_time(2, static_cast<std::uint64_t>(kNs + 197'000));
  for (std::size_t column = 0; column < 3; ++column) packet.set_return(column, 10, 5000);
  ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 3U);
  EXPECT_EQ(bench.points()[0].time_s, 0.0F);
  EXPECT_NEAR(bench.points()[1].time_s, 84e-6, 1e-10);
  EXPECT_NEAR(bench.points()[2].time_s, 197e-6, 1e-10);
  ASSERT_TRUE(bench.flush());
  EXPECT_EQ(bench.swept()[0].start_utc_ns, kNs);
  EXPECT_EQ(bench.swept()[0].time_source, TimeSource::sensor);
}

TEST(OusterDecoder, LeavesOutColumnsThatTheSensorCallsBadOrTheWindowExcludes) {
  for (const Profile profile : {Profile::legacy, Profile::single}) {
    Metadata metadata = ouster_metadata(profile);
    metadata.window = {.first = 1, .last = 1022};
    auto bench = bench_of(metadata);
    OusterPacket packet = sound_packet(metadata);
    for (std::size_t column = 0; column < 16; ++column)
      packet.set_return(column, 0, 5000, static_cast<unsigned>(column));
    packet.set_valid(3, false);
    packet.set_time(3, 0);  // nothing of it is believed
    if (profile == Profile::single)
      packet.set(packet.column_at(4) + 10, 0xFFFF, 2);  // upper bits mean nothing
    ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
    ASSERT_EQ(bench.points().size(), 14U);
    EXPECT_EQ(bench.points()[0].intensity, 1.0F);
    EXPECT_EQ(bench.points()[2].intensity, 4.0F);
    EXPECT_NEAR(bench.points()[2].time_s, 3 * 97.656e-6, 1e-9) << "from the first column that counts";
  }
}

TEST(OusterDecoder, ReadsThe64RowsOfOldFirmwareWhereBeamsAreFewer) {
  Metadata metadata = ouster_metadata(Profile::legacy, 64);
  metadata.beam_count = 16;
  std::uint16_t ring = 16;
  for (std::size_t i = 0; i < 64; ++i) {
    metadata.rows[i].present = i % 4 == 3;
    if (metadata.rows[i].present) metadata.rows[i].ring = --ring;
  }
  auto bench = bench_of(metadata);
  OusterPacket packet = sound_packet(metadata);
  for (std::size_t row = 0; row < 64; ++row) packet.set_return(0, row, 5000, static_cast<unsigned>(row));
  ASSERT_EQ(packet.bytes().size(), 12608U);
  ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 16U);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(bench.points()[i].intensity, static_cast<float>(4 * i + 3));
    EXPECT_EQ(bench.points()[i].ring, 15 - i);
  }
}

TEST(OusterDecoder, ChecksTheChecksumWhereThereIsOne) {
  const Metadata metadata = ouster_metadata(Profile::single);
  const auto status = [&](std::uint64_t footer, bool damage, Metadata unit) {
    auto bench = bench_of(unit);
    OusterPacket packet = sound_packet(unit);
    packet.set_return(1, 2, 5000);
    packet.set_crc();
    if (footer != 1) packet.set(packet.bytes().size() - 8, footer, 8);
    if (damage) packet.set(5000, 0x77, 1);
    return bench.decode(packet.bytes()).status;
  };
  EXPECT_EQ(status(1, false, metadata), DecodeStatus::decoded);
  EXPECT_EQ(status(1, true, metadata), DecodeStatus::wrong_checksum);
  EXPECT_EQ(status(2, false, metadata), DecodeStatus::wrong_checksum);
  EXPECT_EQ(status(0, true, metadata), DecodeStatus::decoded) << "firmware 2.2 sends none";
  EXPECT_EQ(status(0xDEAD'BEEF'0000'C0DE, true, metadata), DecodeStatus::decoded) << "nor do 2.3 and 2.4";
  Metadata fusa = metadata;
  fusa.header_type = HeaderType::fusa;
  EXPECT_EQ(status(2, false, fusa), DecodeStatus::decoded) << "nor any with this header";
}

TEST(OusterDecoder, RefusesAnotherUnitsPackets) {
  for (const HeaderType header : {HeaderType::standard, HeaderType::fusa}) {
    Metadata metadata = ouster_metadata(Profile::single);
    metadata.header_type = header;
    metadata.serial_number = 122'201'000'998;
    const auto status = [&](std::uint64_t serial_number) {
      auto bench = bench_of(metadata);
      OusterPacket packet = sound_packet(metadata);
      packet.set_serial_number(serial_number);
      return bench.decode(packet.bytes()).status;
    };
    EXPECT_EQ(status(122'201'000'998), DecodeStatus::decoded);
    EXPECT_EQ(status(0), DecodeStatus::decoded) << "not told";
    EXPECT_EQ(status(122'201'000'999), DecodeStatus::wrong_model);
    metadata.serial_number = 0;
    EXPECT_EQ(status(122'201'000'999), DecodeStatus::decoded) << "nothing to compare with";
  }
}

TEST(OusterDecoder, RefusesAPacketThatIsNotWhatItShouldBe) {
  for (const Profile profile : {Profile::legacy, Profile::low_rate}) {
    Metadata metadata = ouster_metadata(profile);
    metadata.window = {.first = 0, .last = 511};
    auto bench = bench_of(metadata);
    const auto status = [&](auto change) {
      OusterPacket packet = sound_packet(metadata);
      packet.set_return(0, 0, 1000);
      change(packet);
      return bench.decode(packet.bytes()).status;
    };
    EXPECT_EQ(status([](auto& p) { p.set_column_id(5, 7); }), DecodeStatus::wrong_header);
    EXPECT_EQ(status([](auto& p) { p.set_place(64, kNs); }), DecodeStatus::wrong_header) << "no such column";
    EXPECT_EQ(status([](auto& p) { p.set_place(32, kNs); }), DecodeStatus::wrong_header)
        << "not in the window";
    EXPECT_EQ(status([](auto& p) {
                for (unsigned i = 0; i < 16; ++i) p.set_column_id(i, 8 + i);
              }),
              DecodeStatus::wrong_header)
        << "no multiple of 16";
    EXPECT_EQ(status([](auto& p) { p.set_time(5, kNs); }), DecodeStatus::wrong_time) << "back";
    EXPECT_EQ(status([](auto& p) { p.set_time(15, kNs + 50'000'000); }), DecodeStatus::wrong_time)
        << "a leap";
    EXPECT_EQ(status([](auto& p) { p.set_time(0, ~std::uint64_t{0}); }), DecodeStatus::wrong_time);
    if (profile == Profile::legacy) {
      EXPECT_EQ(status([](auto& p) { p.set(p.column_at(3) + 10, 1, 2); }), DecodeStatus::wrong_header)
          << "columns of two frames";
    } else {
      EXPECT_EQ(status([](auto& p) { p.set(0, 4, 2); }), DecodeStatus::wrong_header) << "no lidar packet";
    }
    EXPECT_TRUE(bench.all_points().empty());
    EXPECT_EQ(status([](auto&) {}), DecodeStatus::decoded);
  }
}

TEST(OusterDecoder, KnowsTheSensorsOtherPackets) {
  const auto status = [](const Metadata& metadata, std::size_t size, unsigned type) {
    auto bench = bench_of(metadata);
    std::vector<std::byte> payload(size);
    if (size > 1) payload[0] = static_cast<std::byte>(type);
    return bench.decode(payload).status;
  };
  const Metadata single = ouster_metadata(Profile::single);
  EXPECT_EQ(status(ouster_metadata(Profile::legacy), 48, 0), DecodeStatus::telemetry);
  EXPECT_EQ(status(single, 48, 0), DecodeStatus::telemetry);
  EXPECT_EQ(status(single, 308, 2), DecodeStatus::telemetry) << "4 measurements of the IMU";
  EXPECT_EQ(status(single, 452, 2), DecodeStatus::telemetry) << "8";
  EXPECT_EQ(status(single, 680, 3), DecodeStatus::telemetry) << "zones";
  EXPECT_EQ(status(single, 453, 2), DecodeStatus::wrong_size);
  EXPECT_EQ(status(single, 308, 1), DecodeStatus::wrong_size);
  EXPECT_EQ(status(single, 544, 0), DecodeStatus::wrong_size) << "somebody else's";
  Metadata fusa = ouster_metadata(Profile::low_rate_dual_fusa);
  EXPECT_EQ(status(fusa, 452, 2), DecodeStatus::telemetry);
  // A lidar packet of 32 rows is as long as an IMU packet of 175 measurements, and may begin with any time.
  Metadata legacy32 = ouster_metadata(Profile::legacy, 32);
  auto bench = bench_of(legacy32);
  OusterPacket packet(legacy32);
  packet.set_place(0, (kNs & ~std::int64_t{0xFFFF}) | 2);
  EXPECT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
}

TEST(OusterDecoder, NeedsTheUnitsMetadata) {
  const SensorModel& model = *find_sensor_model("os1-64");
  EXPECT_THROW(static_cast<void>(make_decoder(model, {})), std::runtime_error);
  EXPECT_THROW(static_cast<void>(make_decoder(model, {}, ouster_metadata(Profile::single, 32))),
               std::runtime_error);
}

TEST(OusterModels, AreRecognisedByTheirOwnPackets) {
  for (std::size_t i = 0; i < ouster::kProfiles.size(); ++i) {
    for (const std::size_t rows : {16U, 32U, 64U, 128U}) {
      Metadata metadata = ouster_metadata(static_cast<Profile>(i), rows, 2048);
      OusterPacket packet = sound_packet(metadata, 100);
      if (i == 0) {
        for (std::size_t column = 0; column < 16; ++column)
          packet.set(packet.column_at(column) + 12, (1600 + column) * 44, 4);
      }
      for (const SensorModel& model : sensor_models()) {
        if (model.format != PacketFormat::ouster) continue;
        if (model.beam_count == rows) {
          EXPECT_TRUE(looks_like(model, packet.bytes())) << model.name << " " << ouster::kProfiles[i].name;
          EXPECT_TRUE(has_size_of(model, packet.bytes())) << model.name << " " << ouster::kProfiles[i].name;
        }
        EXPECT_FALSE(looks_like(model, packet.bytes().first(packet.bytes().size() - 1)));
      }
      packet.set_column_id(7, 3);
      EXPECT_FALSE(looks_like(*find_sensor_model("os1-64"), packet.bytes())) << ouster::kProfiles[i].name;
    }
  }
}

}  // namespace
}  // namespace landfix::drivers
