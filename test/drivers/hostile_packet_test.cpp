// Bad input is normal: whatever arrives is decoded or refused whole, and never believed.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "drivers/velodyne/position_packet.hpp"
#include "support/decoder_bench.hpp"
#include "support/hdl64_packets.hpp"
#include "support/ouster_packets.hpp"
#include "support/robosense_packets.hpp"
#include "support/synthetic_packets.hpp"

namespace landfix::drivers {
namespace {

using test::DecoderBench;

bool is_robosense(std::string_view model) { return find_sensor_model(model)->vendor == "RoboSense"; }

ouster::Profile ouster_profile(std::string_view model) {
  if (model == "os1-64") return ouster::Profile::legacy;
  return model == "os0-32" ? ouster::Profile::dual : ouster::Profile::low_rate;
}

/// Of a unit, where the model needs it.
Calibration calibration_of(std::string_view name) {
  const SensorModel& model = *find_sensor_model(name);
  if (model.format == PacketFormat::ouster)
    return test::ouster_metadata(ouster_profile(name), model.beam_count);
  if (name.starts_with("hdl64")) return velodyne::Hdl64Calibration{};
  return {};
}

std::vector<std::byte> sound_pandar(test::PandarPacket packet) {
  packet.set_azimuths(35970, 20, 2);
  for (std::size_t slot = 0; slot < packet.lasers(); ++slot) packet.set_return(1, slot, 500);
  return {packet.bytes().begin(), packet.bytes().end()};
}

/// A sound packet of each model, full of returns.
std::vector<std::byte> sound_packet(std::string_view model) {
  if (model == "pandar64") return sound_pandar(test::Pandar64Packet(0x39, 6, 7));
  if (model == "pandar40p") return sound_pandar(test::Pandar40pPacket(0x39, 7));
  if (is_robosense(model)) {
    test::RobosensePacket packet(model);
    packet.set_azimuths(35970, 20, model == "rs32" ? 2 : 1);
    for (std::size_t slot = 0; slot < 32; ++slot) packet.set_return(1, slot, 500);
    return {packet.bytes().begin(), packet.bytes().end()};
  }
  if (model.starts_with("os")) {
    test::OusterPacket packet(std::get<ouster::Metadata>(calibration_of(model)));
    packet.set_place(3, test::kReceiveUtcNs);
    for (std::size_t row = 0; row < 32; ++row) packet.set_return(1, row, 500);
    return {packet.bytes().begin(), packet.bytes().end()};
  }
  if (model.starts_with("hdl64")) {
    // Two returns of an S3; the others' rotor seems to stand still for a moment.
    auto packet = model == "hdl64s1" ? test::hdl64s1_packet(35950, 11) : test::hdl64_packet(35950, 20, 2);
    for (std::size_t slot = 0; slot < 32; ++slot) packet.set_return(1, slot, 500);
    return {packet.bytes().begin(), packet.bytes().end()};
  }
  if (model == "vls128") {
    test::VelodynePacket packet(0xA1, 0x37);
    constexpr std::array<std::uint16_t, 4> kFlags{0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
    for (std::size_t block = 0; block < 12; ++block) packet.set_flag(block, kFlags[block % 4]);
    packet.set_azimuths(35980, 20, 4);
    for (std::size_t slot = 0; slot < 32; ++slot) packet.set_return(1, slot, 500);
    return {packet.bytes().begin(), packet.bytes().end()};
  }
  test::VelodynePacket packet(find_sensor_model(model)->product_id, 0x39);
  packet.set_azimuths(35950, 40, 2);
  for (std::size_t slot = 0; slot < 32; ++slot) packet.set_return(1, slot, 500);
  return {packet.bytes().begin(), packet.bytes().end()};
}

class HostilePacket : public testing::TestWithParam<const char*> {
 protected:
  /// Calibrated as the unit brings it, in its own packet or by its file.
  static DecoderBench bench(std::size_t capacity = 100'000) {
    DecoderBench bench(GetParam(), {}, capacity, calibration_of(GetParam()));
    if (is_robosense(GetParam())) {
      EXPECT_EQ(bench.decode(test::robosense_unit(GetParam()).bytes()).status, DecodeStatus::telemetry);
    }
    return bench;
  }

  static void expect_sane(DecoderBench& bench) {
    for (const Point& point : bench.points()) {
      ASSERT_TRUE(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z));
      ASSERT_GE(point.time_s, 0.0F);
      ASSERT_LT(point.ring, 128);
    }
  }
};

TEST_P(HostilePacket, EveryOtherLengthIsRefused) {
  const auto sound = sound_packet(GetParam());
  const SensorModel& model = *find_sensor_model(GetParam());
  DecoderBench bench = HostilePacket::bench();
  for (std::size_t size = 0; size <= sound.size() + 8; ++size) {
    std::vector<std::byte> payload(size);  // its own block of memory: a sanitizer sees a read beyond it
    std::copy_n(sound.begin(), std::min(size, sound.size()), payload.begin());
    const bool known = std::ranges::find(model.payload_sizes, size) != model.payload_sizes.end();
    if (known) continue;
    const DecodeStatus status = bench.decode(payload).status;
    if (status == DecodeStatus::telemetry && model.telemetry_port != 0) continue;
    if (model.vendor == "Velodyne" && model.telemetry_port != 0 && size == velodyne::kPositionBytes) {
      EXPECT_EQ(status, DecodeStatus::wrong_time);  // the size of a position packet, and no time in it
      continue;
    }
    EXPECT_EQ(status, DecodeStatus::wrong_size) << size;
  }
  EXPECT_TRUE(bench.all_points().empty());
  EXPECT_EQ(bench.decode(sound).status, DecodeStatus::decoded);
}

TEST_P(HostilePacket, RandomBytesOfTheRightSizeAreRefused) {
  std::vector<std::byte> payload(sound_packet(GetParam()).size());
  DecoderBench bench = HostilePacket::bench();
  std::mt19937_64 random(1);
  for (int i = 0; i < 100'000; ++i) {
    for (std::size_t at = 0; at + 8 <= payload.size(); at += 8) {
      const std::uint64_t bits = random();
      std::memcpy(&payload[at], &bits, sizeof(bits));
    }
    ASSERT_NE(bench.decode(payload).status, DecodeStatus::decoded);
  }
  EXPECT_TRUE(bench.all_points().empty());
}

TEST_P(HostilePacket, FlippedBitsAndWildReceiveTimesDoNoHarm) {
  const auto sound = sound_packet(GetParam());
  // Now and then a new decoder: one that has seen a packet knows it again, and what time it is.
  std::optional<DecoderBench> bench;
  std::mt19937_64 random(2);
  std::uniform_int_distribution<std::size_t> any_bit(0, sound.size() * 8 - 1);
  std::uniform_int_distribution<std::int64_t> any_time(std::numeric_limits<std::int64_t>::min(),
                                                       std::numeric_limits<std::int64_t>::max());
  int decoded = 0;
  for (int i = 0; i < 20'000; ++i) {
    if (i % 3 == 0) bench.emplace(HostilePacket::bench(4000));
    auto payload = sound;
    for (int flips = 0; flips < 1 + i % 4; ++flips) {
      const std::size_t bit = any_bit(random);
      payload[bit / 8] ^= std::byte{1} << (bit % 8);
    }
    const bool was_decoded = bench->decode(payload, any_time(random)).status == DecodeStatus::decoded;
    decoded += was_decoded ? 1 : 0;
    expect_sane(*bench);
  }
  EXPECT_GT(decoded, 1000) << "flips among the returns are not seen";
}

TEST_P(HostilePacket, AFullSweepCountsWhatDoesNotFit) {
  DecoderBench bench = HostilePacket::bench(10);
  ASSERT_EQ(bench.decode(sound_packet(GetParam())).status, DecodeStatus::decoded);
  ASSERT_TRUE(bench.swept().empty() ? bench.flush() : true);
  const auto& sweep = bench.swept().at(0);
  EXPECT_EQ(sweep.points.size(), 10U);
  const std::string_view model(GetParam());
  EXPECT_EQ(sweep.overflowed, model == "pandar64" ? 54U : model == "pandar40p" ? 30U : 22U);
  EXPECT_FALSE(sweep.complete);
}

INSTANTIATE_TEST_SUITE_P(EveryModel, HostilePacket,
                         testing::Values("vls128", "hdl64s2", "hdl64s3", "hdl64s1", "hdl32e", "vlp32c",
                                         "vlp16", "vlp16hires", "pandar64", "pandar40p", "os1-64", "os0-32",
                                         "os2-128", "rs32", "rs16", "helios16p"),
                         [](const auto& model) {
                           std::string name(model.param);
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace landfix::drivers
