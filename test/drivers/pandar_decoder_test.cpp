#include "drivers/hesai/pandar_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "drivers/civil_time.hpp"
#include "support/decoder_bench.hpp"
#include "support/synthetic_packets.hpp"

namespace landfix::drivers {
namespace {

using test::DecoderBench;
using test::Pandar40pPacket;
using test::Pandar64Packet;
using test::PandarPacket;

constexpr std::uint8_t kStrongest = 0x37;
constexpr std::uint8_t kLast = 0x38;
constexpr std::uint8_t kDual = 0x39;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;

RotorVector vector(const Point& point) {
  return {.x = static_cast<double>(point.x),
          .y = static_cast<double>(point.y),
          .z = static_cast<double>(point.z)};
}

/// What is to be expected of a model, typed from its manual's appendix and the list of its firing times.
struct Model {
  const char* name;
  PandarPacket (*packet)(std::uint8_t mode);
  std::size_t channel;  ///< an example
  double elevation_deg;
  double azimuth_offset_deg;
  double firing_time_us;
  double last_block_us;       ///< its end, before the packet's time
  double earliest_single_us;  ///< point of a packet
  double earliest_dual_us;
};
const Model kModels[] = {
    {"pandar64", [](std::uint8_t mode) -> PandarPacket { return Pandar64Packet(mode); }, 21, -0.508, 5.208,
     -29.084, -42.58, -375.048, -208.368},
    {"pandar40p", [](std::uint8_t mode) -> PandarPacket { return Pandar40pPacket(mode); }, 8, 1.351, -5.208,
     -54.67, -28.58, -583.29, -305.49},
};

class PandarDecoder : public testing::TestWithParam<Model> {
 protected:
  static PandarPacket packet(std::uint8_t mode = kStrongest) { return GetParam().packet(mode); }
  static const Beam& beam(std::size_t channel) {
    return find_sensor_model(GetParam().name)->beams[channel - 1];
  }
};

TEST_P(PandarDecoder, PointsABeamWhereTheManualSays) {
  const Model& model = GetParam();
  DecoderBench bench(model.name, {.optical_centre = false});
  PandarPacket sent = packet();
  sent.set_azimuths(10000, 20);
  sent.set_return(0, model.channel - 1, 2500, 200);
  ASSERT_EQ(bench.decode(sent.bytes()).status, DecodeStatus::decoded);
  ASSERT_EQ(bench.points().size(), 1U);
  const Point& point = bench.points()[0];
  // At 600 rpm the rotor turns 3600 deg/s: fired before the end of the block, it points less far on.
  const double azimuth_rad =
      (100.0 + model.azimuth_offset_deg + 3600.0 * model.firing_time_us * 1e-6) * kRadPerDeg;
  const double elevation_rad = model.elevation_deg * kRadPerDeg;
  EXPECT_NEAR(point.x, 10.0 * std::cos(elevation_rad) * std::cos(azimuth_rad), 5e-6);
  EXPECT_NEAR(point.y, -10.0 * std::cos(elevation_rad) * std::sin(azimuth_rad), 5e-6);
  EXPECT_NEAR(point.z, 10.0 * std::sin(elevation_rad), 5e-6);
  EXPECT_EQ(point.ring, find_sensor_model(model.name)->beam_count - model.channel);
  EXPECT_EQ(point.intensity, 200.0F);
}

TEST_P(PandarDecoder, TurnsByTheFiringTimeAtTheSpeedThatThePacketTells) {
  const Model& model = GetParam();
  const auto azimuth_deg = [&](const DecoderOptions& options, unsigned rpm) {
    DecoderBench bench(model.name, options);
    PandarPacket sent = packet();
    sent.set_azimuths(10000, 20);
    sent.set_rpm(rpm);
    sent.set_return(0, model.channel - 1, 2500);
    static_cast<void>(bench.decode(sent.bytes()));
    const Point& point = bench.points()[0];
    return std::atan2(-vector(point).y, vector(point).x) / kRadPerDeg;
  };
  const double rest_deg = azimuth_deg({.firing_time_azimuth = false, .optical_centre = false}, 600);
  EXPECT_NEAR(rest_deg, 100.0 + model.azimuth_offset_deg, 1e-5);
  EXPECT_NEAR(azimuth_deg({.optical_centre = false}, 1200) - rest_deg, 7200e-6 * model.firing_time_us, 1e-5);
  EXPECT_NEAR(azimuth_deg({.optical_centre = false}, 602) - rest_deg, 3612e-6 * model.firing_time_us, 1e-5);
  EXPECT_NEAR(azimuth_deg({.optical_centre = false}, 0) - rest_deg, 3600e-6 * model.firing_time_us, 1e-5)
      << "not told: the nominal speed";
}

TEST_P(PandarDecoder, MeasuresTheRangeFromTheCentreAndStartsTheBeamBesideIt) {
  constexpr double kRangeM = 2.0;
  constexpr double kForwardM = 0.03873;
  constexpr double kLeftM = 0.012;
  DecoderBench plain(GetParam().name, {.optical_centre = false});
  DecoderBench centred(GetParam().name);
  PandarPacket sent = packet();
  sent.set_azimuths(0, 20);
  for (std::size_t slot = 0; slot < sent.lasers(); ++slot)
    sent.set_return(0, slot, static_cast<unsigned>(kRangeM / 0.004));
  static_cast<void>(plain.decode(sent.bytes()));
  static_cast<void>(centred.decode(sent.bytes()));
  ASSERT_EQ(centred.points().size(), sent.lasers());
  for (std::size_t i = 0; i < sent.lasers(); ++i) {
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

TEST_P(PandarDecoder, DatesEachFiringBackFromThePacketsTime) {
  const Model& model = GetParam();
  for (const std::uint8_t mode : {kStrongest, kDual}) {
    const std::size_t returns = mode == kDual ? 2 : 1;
    DecoderBench bench(model.name);
    PandarPacket sent = packet(mode);
    const std::size_t blocks = sent.blocks();
    sent.set_azimuths(10000, 20, returns);
    sent.set_microseconds(500'000);
    sent.set_return(0, 0, 1000);
    sent.set_return(blocks - 1, sent.lasers() - 1, 1000);
    const std::int64_t packed_utc_ns = PandarPacket::kDateUtcNs + 500'000'000;
    ASSERT_EQ(bench.decode(sent.bytes(), packed_utc_ns + 1'000'000).status, DecodeStatus::decoded);
    ASSERT_TRUE(bench.flush());
    const auto& sweep = bench.swept().at(0);
    EXPECT_EQ(sweep.time_source, TimeSource::sensor);
    ASSERT_EQ(sweep.points.size(), 2U);
    const double start_us = static_cast<double>(sweep.start_utc_ns - packed_utc_ns) * 1e-3;
    EXPECT_NEAR(start_us, returns == 2 ? model.earliest_dual_us : model.earliest_single_us, 0.001);
    const std::size_t firings = blocks / returns;
    const double before_us = static_cast<double>(firings - 1) * 55.56;
    EXPECT_NEAR(start_us + static_cast<double>(sweep.points[0].time_s) * 1e6,
                model.last_block_us - before_us + beam(1).firing_time_us, 0.01);
    EXPECT_NEAR(start_us + static_cast<double>(sweep.points[1].time_s) * 1e6,
                model.last_block_us + beam(sent.lasers()).firing_time_us, 0.01);
  }
}

TEST_P(PandarDecoder, KeepsBothReturnsOfAFiringButNotTheSameTwice) {
  DecoderBench bench(GetParam().name);
  PandarPacket sent = packet(kDual);
  sent.set_azimuths(10000, 20, 2);
  sent.set_return(0, 0, 2000, 10);  // last and strongest, apart
  sent.set_return(1, 0, 1000, 90);
  sent.set_return(0, 1, 3000, 20);  // one echo, written twice
  sent.set_return(1, 1, 3000, 20);
  sent.set_return(0, 2, 4000, 30);  // no second
  sent.set_return(2, 1, 3000, 40);  // another firing: no copy
  ASSERT_EQ(bench.decode(sent.bytes()).status, DecodeStatus::decoded);
  std::vector<float> intensities;
  for (const Point& point : bench.points()) intensities.push_back(point.intensity);
  EXPECT_EQ(intensities, (std::vector<float>{10.0F, 20.0F, 30.0F, 90.0F, 40.0F}));
  EXPECT_EQ(bench.points()[0].time_s, bench.points()[3].time_s) << "two returns of one pulse";
}

TEST_P(PandarDecoder, DocumentsThreeReturnModes) {
  for (unsigned mode = 0; mode < 256; ++mode) {
    DecoderBench bench(GetParam().name);
    PandarPacket sent = packet(static_cast<std::uint8_t>(mode));
    sent.set_azimuths(1000, 20, 2);
    const bool known = mode == kStrongest || mode == kLast || mode == kDual;
    EXPECT_EQ(bench.decode(sent.bytes()).status,
              known ? DecodeStatus::decoded : DecodeStatus::wrong_return_mode)
        << mode;
  }
}

/// The example of a GPS packet in the manuals' words: date and time in ASCII digits, the units first.
std::vector<std::byte> gps_packet(const std::array<unsigned, 6>& date, char status, unsigned pulse) {
  std::vector<std::byte> packet(512, std::byte{0xDF});
  packet[0] = std::byte{0xFF};
  packet[1] = std::byte{0xEE};
  constexpr std::size_t kAt[] = {2, 4, 6, 12, 10, 8};  // year, month, day, hour, minute, second
  for (std::size_t i = 0; i < date.size(); ++i) {
    packet[kAt[i]] = static_cast<std::byte>('0' + date[i] % 10);
    packet[kAt[i] + 1] = static_cast<std::byte>('0' + date[i] / 10);
  }
  for (std::size_t i = 14; i < 18; ++i) packet[i] = std::byte{0};
  packet[506] = static_cast<std::byte>(status);
  packet[507] = static_cast<std::byte>(pulse);
  return packet;
}

TEST_P(PandarDecoder, KnowsTheGpsPacketWhichHoldsNoPoints) {
  DecoderBench bench(GetParam().name);
  auto gps = gps_packet({20, 6, 25, 12, 2, 9}, 'A', 1);
  EXPECT_EQ(bench.decode(gps).status, DecodeStatus::telemetry);
  EXPECT_EQ(bench.decode(gps_packet({99, 99, 99, 99, 99, 99}, 'V', 0)).status, DecodeStatus::telemetry);
  gps[0] = std::byte{0xFE};
  EXPECT_TRUE(is_rejected(bench.decode(gps).status));
}

TEST_P(PandarDecoder, TrustsItsDateAgainstTheReceiversClockOnceSatellitesAreLocked) {
  const std::int64_t receive_utc_ns = PandarPacket::kDateUtcNs + std::int64_t{86'400'000'000'000};
  const auto source_after = [&](std::span<const std::byte> gps) {
    DecoderBench bench(GetParam().name);
    static_cast<void>(bench.decode(gps, receive_utc_ns));
    PandarPacket sent = packet();
    sent.set_azimuths(1000, 20);
    sent.set_return(0, 0, 1000);
    EXPECT_EQ(bench.decode(sent.bytes(), receive_utc_ns + 100'000'000).status, DecodeStatus::decoded);
    EXPECT_TRUE(bench.flush());
    return bench.swept().at(0).time_source;
  };
  EXPECT_EQ(source_after(gps_packet({20, 6, 25, 12, 2, 9}, 'A', 1)), TimeSource::sensor);
  EXPECT_EQ(source_after(gps_packet({20, 6, 25, 12, 2, 9}, 'V', 1)), TimeSource::receive) << "no fix";
  EXPECT_EQ(source_after(gps_packet({20, 6, 25, 12, 2, 9}, 'A', 0)), TimeSource::receive) << "no pulse";
  EXPECT_EQ(source_after(gps_packet({20, 6, 31, 12, 2, 9}, 'A', 1)), TimeSource::receive) << "no date";
  auto garbled = gps_packet({20, 6, 25, 12, 2, 9}, 'A', 1);
  garbled[5] = std::byte{'x'};
  EXPECT_EQ(source_after(garbled), TimeSource::receive) << "no digits";
}

TEST_P(PandarDecoder, RefusesTheMakersOtherModels) {
  struct Other {
    const char* name;
    std::size_t bytes;
    std::array<unsigned, 8> start;
  };
  const Other others[] = {
      {"pandarqt64", 1072, {0xEE, 0xFF, 3, 1, 0, 0, 64, 4}},
      {"pandarqt64, without sequence", 1068, {0xEE, 0xFF, 3, 1, 0, 0, 64, 4}},
      {"pandarxt32", 1080, {0xEE, 0xFF, 6, 1, 0, 0, 32, 8}},
      {"pandar20", 1270, {0xEE, 0xFF, 20, 20, 0, 4, 0, 0}},
      {"pandar40, before the P", 1256, {0xFF, 0xEE, 0x10, 0x27, 1, 1, 1, 1}},
      {"vlp16", 1206, {0xFF, 0xEE, 0x10, 0x27, 1, 1, 1, 1}},
  };
  DecoderBench bench(GetParam().name);
  for (const Other& other : others) {
    std::vector<std::byte> payload(other.bytes);
    for (std::size_t i = 0; i < 8; ++i) payload[i] = static_cast<std::byte>(other.start[i]);
    const DecodeStatus status = bench.decode(payload).status;
    EXPECT_TRUE(status == DecodeStatus::wrong_model || status == DecodeStatus::wrong_size)
        << other.name << ": " << to_string(status);
  }
  for (const Model& model : kModels) {
    PandarPacket sent = model.packet(kStrongest);
    sent.set_azimuths(1000, 20);
    EXPECT_EQ(bench.decode(sent.bytes()).status, std::string_view(model.name) == GetParam().name
                                                     ? DecodeStatus::decoded
                                                     : DecodeStatus::wrong_model);
  }
}

TEST_P(PandarDecoder, RefusesAPacketThatIsNotWhatItShouldBe) {
  DecoderBench bench(GetParam().name);
  const auto status = [&](auto change) {
    PandarPacket sent = packet();
    sent.set_azimuths(1000, 20);
    sent.set_return(0, 0, 1000);
    change(sent);
    return bench.decode(sent.bytes()).status;
  };
  EXPECT_EQ(status([](auto& p) { p.set_byte(0, 0xEF); }), DecodeStatus::wrong_header);
  EXPECT_EQ(status([](auto& p) { p.set_rpm(65535); }), DecodeStatus::wrong_header);
  EXPECT_EQ(status([](auto& p) { p.set_microseconds(1'000'001); }), DecodeStatus::wrong_time);
  EXPECT_EQ(status([](auto& p) { p.set_date({21, 2, 29, 0, 0, 0}); }), DecodeStatus::wrong_time);
  EXPECT_EQ(status([](auto& p) { p.set_date({255, 1, 1, 0, 0, 0}); }), DecodeStatus::wrong_time);
  EXPECT_EQ(status([](auto& p) { p.set_date({21, 0, 1, 0, 0, 0}); }), DecodeStatus::wrong_time);
  EXPECT_EQ(status([](auto& p) { p.set_date({21, 1, 1, 24, 0, 0}); }), DecodeStatus::wrong_time);
  EXPECT_EQ(status([](auto& p) { p.set_date({0, 0, 0, 0, 0, 0}); }), DecodeStatus::wrong_time);
  EXPECT_EQ(status([](auto& p) { p.set_date({0, 0, 255, 0, 0, 0}); }), DecodeStatus::wrong_time);
  EXPECT_EQ(status([](auto& p) { p.set_azimuth(5, 36000); }), DecodeStatus::wrong_azimuth);
  EXPECT_EQ(status([](auto& p) { p.set_azimuths(0, 17000); }), DecodeStatus::wrong_azimuth);
  EXPECT_EQ(status([](auto& p) { p.set_mode(kDual); }), DecodeStatus::wrong_azimuth) << "pairs differ";
  EXPECT_TRUE(bench.all_points().empty());
}

TEST_P(PandarDecoder, CountsYearsFrom2000OrFrom1900) {
  for (const auto& [year, expected] :
       {std::pair{0U, 2000}, {17U, 2017}, {99U, 2099}, {100U, 2000}, {117U, 2017}, {120U, 2020}}) {
    DecoderBench bench(GetParam().name);
    PandarPacket sent = packet();
    sent.set_azimuths(1000, 20);
    sent.set_date({year, 3, 1, 0, 0, 0});
    sent.set_return(0, 0, 1000);
    const std::int64_t utc_ns = *unix_seconds({.year = expected, .month = 3, .day = 1}) * 1'000'000'000;
    ASSERT_EQ(bench.decode(sent.bytes(), utc_ns).status, DecodeStatus::decoded);
    ASSERT_TRUE(bench.flush());
    EXPECT_EQ(bench.swept().at(0).time_source, TimeSource::sensor) << year;
  }
}

/// Start of a sweep of one packet with that date, on the sensor's clock.
std::int64_t start_ns(PandarPacket sent, std::uint32_t microseconds, const std::array<unsigned, 6>& date,
                      const char* name, std::int64_t receive_utc_ns) {
  DecoderBench bench(name);
  sent.set_azimuths(1000, 20);
  sent.set_date(date);
  sent.set_microseconds(microseconds);
  sent.set_return(0, 0, 1000);
  EXPECT_EQ(bench.decode(sent.bytes(), receive_utc_ns).status, DecodeStatus::decoded);
  EXPECT_TRUE(bench.flush());
  EXPECT_EQ(bench.swept().at(0).time_source, TimeSource::sensor);
  return bench.swept().at(0).start_utc_ns;
}

TEST_P(PandarDecoder, ReadsADateWithoutMonthAsUnixSeconds) {
  constexpr std::int64_t kSeconds = 0x69'F8'C5'14;  // most significant byte first on the wire
  const char* const name = GetParam().name;
  const std::int64_t counted =
      start_ns(packet(), 0, {0, 0, 0x69, 0xF8, 0xC5, 0x14}, name, kSeconds * 1'000'000'000);
  EXPECT_NEAR(static_cast<double>(counted - kSeconds * 1'000'000'000) * 1e-3, GetParam().earliest_single_us,
              0.001);
}

TEST_P(PandarDecoder, TakesTheMicrosecondThatCompletesTheSecond) {
  const char* const name = GetParam().name;
  const std::int64_t before =
      start_ns(packet(), 1'000'000, {120, 6, 25, 12, 2, 9}, name, PandarPacket::kDateUtcNs);
  const std::int64_t after = start_ns(packet(), 0, {120, 6, 25, 12, 2, 10}, name, PandarPacket::kDateUtcNs);
  EXPECT_EQ(before, after);
}

TEST_P(PandarDecoder, AnUnsynchronisedSensorKeepsItsSpacingButNotItsDate) {
  DecoderBench bench(GetParam().name);
  PandarPacket sent = packet();
  sent.set_azimuths(1000, 20);
  sent.set_date({17, 1, 1, 0, 0, 0});
  sent.set_return(0, 0, 1000);
  ASSERT_EQ(bench.decode(sent.bytes()).status, DecodeStatus::decoded);
  ASSERT_TRUE(bench.flush());
  EXPECT_EQ(bench.swept().at(0).time_source, TimeSource::receive);
}

INSTANTIATE_TEST_SUITE_P(EveryModel, PandarDecoder, testing::ValuesIn(kModels),
                         [](const auto& model) { return std::string(model.param.name); });

TEST(Pandar64Packets, SayTheirCountsAndUnitInTheHeader) {
  DecoderBench bench("pandar64");
  Pandar64Packet seven(kStrongest, 7);
  seven.set_azimuths(10000, 20);
  seven.set_return(6, 0, 1000);
  EXPECT_EQ(bench.decode(seven.bytes()).status, DecodeStatus::decoded);
  EXPECT_EQ(bench.all_points().size(), 1U);
  Pandar64Packet unit;
  unit.set_azimuths(10280, 20);
  unit.set_byte(5, 8);
  unit.set_return(0, 0, 1000);
  unit.set_microseconds(389);
  EXPECT_EQ(bench.decode(unit.bytes()).status, DecodeStatus::decoded);
  const Point point = bench.all_points().back();
  EXPECT_NEAR(std::hypot(point.x, point.y, point.z), 8.0, 1e-5);
}

TEST(Pandar64Packets, MustFitTheirHeader) {
  DecoderBench bench("pandar64");
  const auto status = [&](std::size_t at, unsigned value) {
    Pandar64Packet packet;
    packet.set_azimuths(1000, 20);
    packet.set_byte(at, value);
    return bench.decode(packet.bytes()).status;
  };
  EXPECT_EQ(status(2, 40), DecodeStatus::wrong_model);
  EXPECT_EQ(status(3, 5), DecodeStatus::wrong_header);
  EXPECT_EQ(status(3, 7), DecodeStatus::wrong_size);
  EXPECT_EQ(status(5, 0), DecodeStatus::wrong_header);
  EXPECT_EQ(bench.decode(Pandar64Packet(kDual, 7).bytes()).status, DecodeStatus::wrong_header)
      << "seven blocks are no pairs";
}

TEST(Pandar40pPackets, MarkEveryBlock) {
  for (std::size_t block = 0; block < 10; ++block) {
    Pandar40pPacket packet;
    packet.set_azimuths(1000, 20);
    packet.set_byte(124 * block + 1, 0xEF);
    EXPECT_EQ(DecoderBench("pandar40p").decode(packet.bytes()).status, DecodeStatus::wrong_header) << block;
  }
}

/// Packets lost between two that are one packet's duration apart, if their numbers say so.
template <class Sent>
std::uint64_t lost_between(const char* name, Sent first, Sent second, std::uint32_t apart_us) {
  DecoderBench bench(name);
  first.set_azimuths(1000, 20, 2);  // in pairs, as dual return wants it
  second.set_azimuths(1200, 20, 2);
  second.set_microseconds(apart_us);
  for (const Sent& sent : {first, second}) {
    EXPECT_EQ(bench.decode(sent.bytes(), PandarPacket::kDateUtcNs).status, DecodeStatus::decoded);
  }
  return bench.counters().lost_packets;
}

TEST(PandarPackets, AreCountedBySequenceOrElseByTime) {
  using P64 = Pandar64Packet;
  using P40 = Pandar40pPacket;
  constexpr std::uint32_t kLatest = 0xFFFF'FFFF;
  EXPECT_EQ(lost_between("pandar64", P64(kStrongest, 6, kLatest), P64(kStrongest, 6, 0), 333), 0U);
  EXPECT_EQ(lost_between("pandar64", P64(kStrongest, 6, 7), P64(kStrongest, 6, 10), 1333), 2U);
  EXPECT_EQ(lost_between("pandar64", P64(), P64(), 333), 0U);
  EXPECT_EQ(lost_between("pandar64", P64(), P64(), 1000), 2U);
  EXPECT_EQ(lost_between("pandar64", P64(kDual), P64(kDual), 167), 0U);
  EXPECT_EQ(lost_between("pandar40p", P40(kStrongest, 7), P40(kStrongest, 8), 556), 0U);
  EXPECT_EQ(lost_between("pandar40p", P40(kStrongest, 7), P40(kStrongest, 9), 1111), 1U);
  EXPECT_EQ(lost_between("pandar40p", P40(), P40(), 556), 0U);
  EXPECT_EQ(lost_between("pandar40p", P40(kDual), P40(kDual), 556), 1U);
}

}  // namespace
}  // namespace landfix::drivers
