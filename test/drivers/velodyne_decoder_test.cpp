// VLP-32C, HDL-32E, VLS-128 and Alpha Prime. The VLP-16 family has a file of its own.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/velodyne/azimuth_offsets.hpp"
#include "drivers/velodyne/vls128_decoder.hpp"
#include "support/decoder_bench.hpp"
#include "support/synthetic_packets.hpp"

namespace landfix::drivers {
namespace {

using test::DecoderBench;
using test::kHourUtcNs;
using test::kTopOfHourUs;
using test::VelodynePacket;

constexpr std::uint8_t kStrongest = 0x37;
constexpr std::uint8_t kDual = 0x39;
constexpr std::uint8_t kTriple = 0x3A;
constexpr std::uint8_t kConfidence = 0x3B;
constexpr std::array<std::uint16_t, 4> kFlags{0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};

/// A packet of a VLS-128, its blocks by sequence, bank and return, at `step_centideg` a sequence.
VelodynePacket vls128_packet(std::uint8_t mode, unsigned first_centideg, unsigned step_centideg = 19) {
  VelodynePacket packet(0xA1, mode);
  const std::size_t a_bank = mode == kStrongest ? 1 : mode == kDual ? 2 : 3;
  for (std::size_t block = 0; block < 12; ++block) {
    const std::size_t sequence = block / (4 * a_bank);
    packet.set_flag(block, kFlags[block % (4 * a_bank) / a_bank]);
    packet.set_azimuth(block, (first_centideg + step_centideg * static_cast<unsigned>(sequence)) % 36000U);
    if (mode == kDual && block >= 8) packet.set_flag(block, block % 2 == 0 ? 0 : 0xFFFF);
  }
  packet.set_time_us(kTopOfHourUs);
  return packet;
}

double azimuth_deg(const Point& point) {
  return -std::atan2(static_cast<double>(point.y), static_cast<double>(point.x)) * 180.0 / std::numbers::pi;
}

TEST(BlockDecoder, GivesTheNumbersWorkedByHandFromTheManuals) {
  struct WorkedNumber {
    const char* model;
    std::uint8_t product;
    unsigned azimuth_centideg, step_centideg;
    std::size_t laser;
    unsigned range_raw;
    double x, y, z, time_us;
  };
  constexpr WorkedNumber kNumbers[] = {
      {"vlp32c", 0x28, 27000, 20, 9, 2500, -0.7266, 9.9734, 0.0581, 9.216},
      {"vlp32c", 0x28, 1000, 20, 28, 25000, 96.8356, -24.7121, -3.4899, 32.256},
      {"hdl32e", 0x21, 18000, 17, 31, 7500, -14.7406, 0.0331, 2.7773, 35.712},
  };
  for (const WorkedNumber& number : kNumbers) {
    DecoderBench bench(number.model);
    VelodynePacket packet(number.product, kStrongest);
    packet.set_azimuths(number.azimuth_centideg, number.step_centideg);
    packet.set_return(0, number.laser, number.range_raw, 77);
    packet.set_time_us(kTopOfHourUs);
    ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
    ASSERT_EQ(bench.points().size(), 1U);
    const Point& point = bench.points()[0];
    EXPECT_NEAR(point.x, number.x, 2e-4) << number.model;
    EXPECT_NEAR(point.y, number.y, 2e-4) << number.model;
    EXPECT_NEAR(point.z, number.z, 2e-4) << number.model;
    EXPECT_NEAR(static_cast<double>(point.time_s) * 1e6, number.time_us, 1e-3);
    EXPECT_EQ(point.intensity, 77.0F);
    EXPECT_EQ(point.ring, find_sensor_model(number.model)->beams[number.laser].ring);
  }
}

TEST(BlockDecoder, TimesTheBlocksOfEachModel) {
  for (const auto& [model, product, block_us] :
       {std::tuple{"vlp32c", 0x28, 55.296}, std::tuple{"hdl32e", 0x21, 46.080}}) {
    for (const std::size_t returns : {std::size_t{1}, std::size_t{2}}) {
      DecoderBench bench(model);
      VelodynePacket packet(static_cast<std::uint8_t>(product), returns == 2 ? kDual : kStrongest);
      packet.set_azimuths(1000, 20, returns);
      packet.set_time_us(kTopOfHourUs);
      for (std::size_t block = 0; block < 12; ++block)
        packet.set_return(block, 0, 1000 + 10 * static_cast<unsigned>(block));
      ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
      ASSERT_EQ(bench.points().size(), 12U);
      for (std::size_t block = 0; block < 12; ++block) {
        const std::size_t firing = block / returns;
        EXPECT_NEAR(static_cast<double>(bench.points()[block].time_s) * 1e6,
                    block_us * static_cast<double>(firing), 1e-2);
      }
    }
  }
}

TEST(BlockDecoder, TakesUnnamedPacketsOnlyOfModelsThatHadSuchFirmware) {
  VelodynePacket unnamed(0, 0);
  unnamed.set_azimuths(1000, 20);
  unnamed.set_time_us(kTopOfHourUs);
  EXPECT_EQ(DecoderBench("hdl32e").decode(unnamed.bytes()).status, DecodeStatus::decoded);
  EXPECT_EQ(DecoderBench("vlp32c").decode(unnamed.bytes()).status, DecodeStatus::wrong_model);
  // The obsolete VLP-32A and VLP-32B have other angles.
  EXPECT_EQ(DecoderBench("vlp32c").decode(VelodynePacket(0x23).bytes()).status, DecodeStatus::wrong_model);
}

/// Two turns and more at 600 rpm, of which the sensor reports what lies from 270 deg to 90 deg: packets are
/// filled up behind the dark sector.
TEST(BlockDecoder, TimesAndTurnsBlocksBehindASectorThatIsLeftOut) {
  constexpr std::size_t kLaser = 30;  // fires late in its sequence
  const SensorModel& model = *find_sensor_model("vlp32c");
  const Beam& beam = model.beams[kLaser];
  DecoderBench bench("vlp32c");
  std::vector<double> true_time_us;
  std::vector<double> true_azimuth_deg;
  VelodynePacket packet(0x28, kStrongest);
  double stamp_us = 0.0;
  int leaps_inside = 0;
  for (int i = 0; i < 8000; ++i) {
    const double time_us = 1e6 + 55.296 * i;
    const double azimuth_centideg = std::fmod(0.36 * time_us, 36000.0);
    if (azimuth_centideg > 9000.0 && azimuth_centideg < 27000.0) continue;
    const std::size_t block = true_time_us.size() % 12;
    if (block == 0) stamp_us = time_us;
    if (block > 0 && true_time_us.back() < time_us - 1e3) ++leaps_inside;
    packet.set_azimuth(block, static_cast<unsigned>(azimuth_centideg));
    packet.set_return(block, kLaser, 5000);
    true_time_us.push_back(time_us + beam.firing_time_us);
    true_azimuth_deg.push_back(0.01 * azimuth_centideg + beam.azimuth_offset_deg +
                               3600e-6 * beam.firing_time_us);
    if (block != 11) continue;
    packet.set_time_us(static_cast<std::uint32_t>(std::lround(stamp_us)));
    const auto receive_ns = kHourUtcNs + static_cast<std::int64_t>(time_us * 1e3) + 1'000'000;
    ASSERT_EQ(bench.decode(packet.bytes(), receive_ns).status, DecodeStatus::decoded);
  }
  ASSERT_TRUE(bench.flush());
  EXPECT_GT(leaps_inside, 2);
  std::size_t count = 0;
  for (const auto& sweep : bench.swept()) {
    for (const Point& point : sweep.points) {
      const double time_us = 1e-3 * static_cast<double>(sweep.start_utc_ns - kHourUtcNs) +
                             1e6 * static_cast<double>(point.time_s);
      // The rate of rotation is known to a part in 500, and dark for 50 ms.
      ASSERT_NEAR(time_us, true_time_us.at(count), 100.0) << count;
      ASSERT_NEAR(std::remainder(azimuth_deg(point) - true_azimuth_deg.at(count), 360.0), 0.0, 0.012)
          << count;
      ++count;
    }
  }
  EXPECT_EQ(count, true_time_us.size() / 12 * 12);
  ASSERT_GT(bench.swept().size(), 3U);
  EXPECT_TRUE(bench.swept()[2].complete) << "what is left out in every turn is not lost";
}

TEST(Vls128Decoder, GivesTheNumbersWorkedByHandFromTheManual) {
  struct WorkedNumber {
    unsigned azimuth_centideg;
    std::size_t laser;
    unsigned range_raw;
    double x, y, z, time_us;
  };
  constexpr WorkedNumber kNumbers[] = {{50, 127, 20000, 79.6021, 7.9460, 0.6004, 42.640},
                                       {12345, 64, 1000, -2.5530, -3.0543, -0.3917, 23.985}};
  for (const char* model : {"vls128", "vls128ap"}) {
    for (const WorkedNumber& number : kNumbers) {
      DecoderBench bench(model);
      VelodynePacket packet = vls128_packet(kStrongest, number.azimuth_centideg);
      packet.set_return(number.laser / 32, number.laser % 32, number.range_raw, 3);
      ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
      ASSERT_EQ(bench.points().size(), 1U);
      const Point& point = bench.points()[0];
      EXPECT_NEAR(point.x, number.x, 5e-4);
      EXPECT_NEAR(point.y, number.y, 5e-4);
      EXPECT_NEAR(point.z, number.z, 5e-4);
      EXPECT_NEAR(static_cast<double>(point.time_s) * 1e6, number.time_us, 1e-2)
          << "since the first group's firing";
      EXPECT_EQ(point.ring, find_sensor_model(model)->beams[number.laser].ring);
    }
  }
}

TEST(Vls128Decoder, ThePacketsTimeIsThatOfTheFourthGroup) {
  DecoderBench bench("vls128");
  VelodynePacket packet = vls128_packet(kStrongest, 1000);
  packet.set_return(0, 0, 1000);
  ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
  ASSERT_TRUE(bench.flush());
  EXPECT_EQ(bench.swept()[0].start_utc_ns, kHourUtcNs + std::int64_t{kTopOfHourUs} * 1000 - 8'700);
}

TEST(Vls128Decoder, MeasuresTheSlotThatItsFirmwareUses) {
  const SensorModel& model = *find_sensor_model("vls128");
  for (const std::uint8_t mode : {kStrongest, kDual}) {
    const double slots = mode == kDual ? 20.0 : 60.0;
    const double slot_us = 2.7639;
    std::vector<Point> storage(200'000);
    SweepPair sweeps(storage);
    velodyne::Vls128Decoder decoder(model.beams.first<128>(), {});
    double azimuth_centideg = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const double time_us = 1e6 + i * slots * slot_us + (i > 1500 ? 20'000.0 : 0.0);  // and a gap
      azimuth_centideg = std::fmod(0.36 * time_us, 36000.0);
      VelodynePacket packet = vls128_packet(mode, static_cast<unsigned>(azimuth_centideg),
                                            static_cast<unsigned>(0.36 * 20 * slot_us));
      packet.set_time_us(static_cast<std::uint32_t>(time_us));
      packet.set_return(mode == kDual ? 6 : 3, 31, 5000);  // laser 127, 16 slots after laser 0
      const auto receive_ns = kHourUtcNs + static_cast<std::int64_t>(time_us * 1e3) + 1'000'000;
      ASSERT_EQ(decoder.decode({packet.bytes(), receive_ns}, sweeps).status, DecodeStatus::decoded);
    }
    EXPECT_NEAR(decoder.slot_us(), slot_us, 0.004) << static_cast<int>(mode);
    // The laser has turned on by the rotation during 16 of the measured slots.
    const Point& point = sweeps.current().points().back();
    const double turned_deg =
        azimuth_deg(point) - azimuth_centideg * 0.01 - model.beams[127].azimuth_offset_deg;
    EXPECT_NEAR(std::remainder(turned_deg, 360.0), 16.0 * slot_us * 3600e-6, 0.012) << static_cast<int>(mode);
  }
}

TEST(Vls128Decoder, KeepsEveryReturnOfABankOnce) {
  for (const std::uint8_t mode : {kDual, kTriple, kConfidence}) {
    DecoderBench bench("vls128");
    VelodynePacket packet = vls128_packet(mode, 1000);
    const std::size_t a_bank = mode == kDual ? 2 : 3;
    for (std::size_t bank = 0; bank < 4; ++bank) {
      packet.set_return(bank * a_bank, 5, 3000, 10);
      packet.set_return(bank * a_bank + 1, 5, 3000, 10);
      packet.set_return(bank * a_bank, 6, 3000, 10);
      packet.set_return(bank * a_bank + 1, 6, 2000, 20);
      if (a_bank == 3) packet.set_return(bank * a_bank + 2, 6, 1000, 30);  // third returns, or confidence
      if (a_bank == 3) packet.set_return(bank * a_bank + 2, 5, 3000, 10);
    }
    // Equal to the first return, not to the second between them.
    if (a_bank == 3) packet.set_return(2, 7, 4000, 40);
    if (a_bank == 3) packet.set_return(0, 7, 4000, 40);
    ASSERT_EQ(bench.decode(packet.bytes()).status, DecodeStatus::decoded);
    std::vector<float> intensities;
    for (const Point& point : bench.points()) intensities.push_back(point.intensity);
    std::vector<float> expected;
    for (int bank = 0; bank < 4; ++bank) {
      expected.insert(expected.end(), {10.0F, 10.0F});
      if (a_bank == 3 && bank == 0) expected.push_back(40.0F);
      expected.push_back(20.0F);
      if (mode == kTriple) expected.push_back(30.0F);
    }
    EXPECT_EQ(intensities, expected) << static_cast<int>(mode);
  }
}

TEST(Vls128Decoder, RefusesPacketsWhoseBlocksAreNotInPlace) {
  const auto status = [](VelodynePacket packet) {
    return DecoderBench("vls128").decode(packet.bytes()).status;
  };
  EXPECT_EQ(status(vls128_packet(kStrongest, 1000)), DecodeStatus::decoded);
  VelodynePacket swapped = vls128_packet(kStrongest, 1000);
  swapped.set_flag(1, kFlags[2]);
  EXPECT_EQ(status(swapped), DecodeStatus::wrong_header);
  VelodynePacket left_over = vls128_packet(kDual, 1000);
  left_over.set_flag(9, kFlags[0]);
  EXPECT_EQ(status(left_over), DecodeStatus::wrong_header);
  VelodynePacket apart = vls128_packet(kStrongest, 1000);
  apart.set_azimuth(2, 1001);
  EXPECT_EQ(status(apart), DecodeStatus::wrong_azimuth) << "the banks of a sequence share an azimuth";
  VelodynePacket mode = vls128_packet(kStrongest, 1000);
  mode.set_mode(0x40);
  EXPECT_EQ(status(mode), DecodeStatus::wrong_return_mode);
  VelodynePacket alias = vls128_packet(kStrongest, 1000);
  alias.set_product(0x63);
  EXPECT_EQ(status(alias), DecodeStatus::decoded) << "the id that another manual prints";
  VelodynePacket other = vls128_packet(kStrongest, 1000);
  other.set_product(0x22);
  EXPECT_EQ(status(other), DecodeStatus::wrong_model);
}

TEST(AzimuthOffsets, AreAddedToTheTable) {
  const auto table = find_sensor_model("vls128")->beams;
  const auto parse = [&table](std::string_view text) {
    return velodyne::parse_azimuth_offsets(std::as_bytes(std::span(text)), "unit.csv", table);
  };
  const auto beams = parse("\xEF\xBB\xBFlaser_id,azimuth_offset_deg\r\n5,0.05\r\n\r\n 127 , -0.1");
  ASSERT_EQ(beams.size(), 128U);
  EXPECT_DOUBLE_EQ(beams[5].azimuth_offset_deg, table[5].azimuth_offset_deg + 0.05);
  EXPECT_DOUBLE_EQ(beams[127].azimuth_offset_deg, table[127].azimuth_offset_deg - 0.1);
  EXPECT_EQ(beams[6].azimuth_offset_deg, table[6].azimuth_offset_deg);
  for (const char* wrong : {"", "laser_id,azimuth_offset_deg\n", "128,0.1", "-1,0.1", "1.5,0.1",
                            "3,0.1\n3,0.1", "3,5.0", "3", "3,x", "3,nan", "a,b\nc,d"}) {
    EXPECT_THROW(static_cast<void>(parse(wrong)), std::runtime_error) << wrong;
  }
}

}  // namespace
}  // namespace landfix::drivers
