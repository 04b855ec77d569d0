// A recorded Helios against the cloud that another driver decoded from it, taking it for a Helios-16P, and
// against the room that it stood in, which shows that it has 32 lasers.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iostream>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/big_endian.hpp"
#include "drivers/robosense/decoder.hpp"
#include "real/cloud_comparison.hpp"
#include "real/wall_profiles.hpp"
#include "support/test_data.hpp"

namespace landfix::drivers {
namespace {

using robosense::kBlocks;
using robosense::kBlockSlots;
using test::Profile;
using test::RecordedPacket;
using test::Return;

constexpr std::uint16_t kDataPort = 6699;
constexpr std::uint16_t kDeviceInfoPort = 7788;
constexpr double kUnitM = 0.0025;

/// The recording, its device information first: the recording has it after most of the data.
std::vector<RecordedPacket> recorded(const std::filesystem::path& capture) {
  auto packets = test::read_packets(capture, kDeviceInfoPort);
  EXPECT_EQ(packets.size(), 1U);
  const auto data = test::read_packets(capture, kDataPort);
  EXPECT_EQ(data.size(), 750U);
  packets.insert(packets.end(), data.begin(), data.end());
  return packets;
}

std::byte* slot_at(RecordedPacket& packet, std::size_t block, std::size_t slot) {
  return &packet.payload[robosense::block_at(block) + 4 + slot * kSlotBytes];
}

/// Blanks the returns that the reference leaves out: 0.2 m and less.
void select_as_the_reference(RecordedPacket& packet) {
  for (std::size_t block = 0; block < kBlocks; ++block) {
    for (std::size_t slot = 0; slot < kBlockSlots; ++slot) {
      std::byte* const at = slot_at(packet, block, slot);
      const double range_m = load_big_endian<std::uint16_t>(at) * kUnitM;
      if (range_m < 0.2 + kUnitM / 2) std::memset(at, 0, 2);
    }
  }
}

std::vector<test::SweepCopy> decode(const AnyDecoder& decoder, std::span<const RecordedPacket> packets) {
  test::DecoderBench bench(decoder, 150'000);
  test::decode_all(bench, packets);
  return bench.swept();
}

std::vector<Point> points_of(std::span<const test::SweepCopy> sweeps) {
  std::vector<Point> points;
  for (const auto& sweep : sweeps) points.insert(points.end(), sweep.points.begin(), sweep.points.end());
  return points;
}

struct ReferencePoint {
  double x_m, y_m, z_m, channel, azimuth_deg, elevation_deg, distance_m, intensity;
};

std::vector<ReferencePoint> read_reference(const std::filesystem::path& path) {
  constexpr std::string_view kColumns[] = {"x",       "y",         "z",        "channel",
                                           "azimuth", "elevation", "distance", "intensity"};
  std::vector<ReferencePoint> points;
  for (const auto& row : test::read_pcd(path, kColumns)) {
    points.push_back({row[0], row[1], row[2], row[3], 0.01 * row[4], 0.01 * row[5], row[6], row[7]});
  }
  return points;
}

TEST(HeliosRealData, AgreesWithTheReferenceThatTakesItForA16P) {
  LANDFIX_REAL_DATA(capture, "helios16p/capture.pcap");
  LANDFIX_REAL_DATA(reference, "helios16p/capture-sweep.pcd");
  auto packets = recorded(capture);
  for (RecordedPacket& packet : std::span(packets).subspan(1)) select_as_the_reference(packet);
  const SensorModel& model = *find_sensor_model("helios16p");
  const auto theirs = read_reference(reference);
  const auto plain = decode(make_decoder(model, {.optical_centre = false}), packets);
  const auto centred = decode(make_decoder(model, {}), packets);
  ASSERT_EQ(plain.size(), 6U);
  const auto& points = plain[1].points;
  ASSERT_EQ(points.size(), theirs.size());
  ASSERT_EQ(points.size(), 15'795U);
  const auto ours = test::to_returns(points);
  double range_m = 0.0;
  double elevation_deg = 0.0;
  double azimuth_deg = 0.0;
  double azimuth_squares = 0.0;
  double position_m_a_m = 0.0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const ReferencePoint& their = theirs[i];
    ASSERT_EQ(ours[i].intensity, their.intensity) << i;
    ASSERT_EQ(points[i].ring, their.channel) << i;
    range_m = std::max(range_m, std::abs(ours[i].range_m - their.distance_m));
    const double elevation = std::asin(ours[i].height_m / ours[i].range_m) * 180.0 / std::numbers::pi;
    elevation_deg = std::max(elevation_deg, std::abs(elevation - their.elevation_deg));
    const double apart_deg = test::degrees_apart(ours[i].azimuth_deg, their.azimuth_deg);
    azimuth_deg = std::max(azimuth_deg, apart_deg);
    azimuth_squares += apart_deg * apart_deg;
    const Point& placed = centred[1].points[i];
    const double apart_m =
        std::hypot(static_cast<double>(placed.x) - their.x_m, static_cast<double>(placed.y) - their.y_m,
                   static_cast<double>(placed.z) - their.z_m);
    position_m_a_m = std::max(position_m_a_m, apart_m / std::max(their.distance_m, 1.0));
  }
  std::cout << "most: range " << range_m << " m, elevation " << elevation_deg << " deg, azimuth "
            << azimuth_deg << " deg (rms " << std::sqrt(azimuth_squares / static_cast<double>(ours.size()))
            << "), position " << position_m_a_m << " m a metre of range\n";
  EXPECT_LT(range_m, 1e-4);
  // The reference truncates elevations: 8.90 deg became 8.89.
  EXPECT_LT(elevation_deg, 0.0101);
  // It truncates the turn since the block's azimuth to 0.01 deg, and takes that turn from the difference to
  // the next block, where we take the mean of a packet: the encoder jitters by 0.01 deg, and in this sweep it
  // was off once by 0.06 deg.
  EXPECT_LT(azimuth_deg, 0.06);
  EXPECT_LT(std::sqrt(azimuth_squares / static_cast<double>(ours.size())), 0.01);
  EXPECT_LT(position_m_a_m, 0.07 * std::numbers::pi / 180.0);
}

TEST(HeliosRealData, SweepsAreWholeAndOnTheReceiversClock) {
  LANDFIX_REAL_DATA(capture, "helios16p/capture.pcap");
  const auto sweeps = decode(make_decoder(*find_sensor_model("helios16p"), {}), recorded(capture));
  ASSERT_EQ(sweeps.size(), 6U);
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    EXPECT_EQ(sweeps[i].complete, i >= 1 && i <= 4) << i;
    // The unit's clock said January 2017 in August 2023.
    EXPECT_EQ(sweeps[i].time_source, TimeSource::receive);
    const double since_s = static_cast<double>(sweeps[i].start_utc_ns - sweeps[0].start_utc_ns) * 1e-9;
    const double expected_s = i == 0 ? 0.0 : 0.0987 + 0.1 * static_cast<double>(i - 1);
    EXPECT_NEAR(since_s, expected_s, 0.002) << i;
  }
  EXPECT_NEAR(static_cast<double>(sweeps[0].start_utc_ns) * 1e-9, 1691031766.6815, 0.002);
}

TEST(HeliosRealData, GivesNoPointBeforeTheUnitHasSaidItsAngles) {
  LANDFIX_REAL_DATA(capture, "helios16p/capture.pcap");
  AnyDecoder decoder = make_decoder(*find_sensor_model("helios16p"), {});
  std::vector<Point> storage(200'000);
  SweepPair sweeps(storage);
  platform::PcapSource source(capture);
  platform::UdpPacket packet;
  std::array<int, kDecodeStatusCount> count{};
  while (source.next(packet) == platform::ReadStatus::packet) {
    const auto result = decoder.decode({packet.payload, packet.receive_utc_ns}, sweeps);
    ++count[static_cast<std::size_t>(result.status)];
  }
  EXPECT_EQ(count[static_cast<std::size_t>(DecodeStatus::telemetry)], 1);
  EXPECT_GT(count[static_cast<std::size_t>(DecodeStatus::uncalibrated)], 400);
  EXPECT_EQ(count[static_cast<std::size_t>(DecodeStatus::uncalibrated)] +
                count[static_cast<std::size_t>(DecodeStatus::decoded)],
            750);
}

/// Of each laser's returns, in the order of the rings.
using ByRing = std::vector<std::vector<Return>>;

struct LaserReturns {
  std::vector<Return> returns;
  double azimuth_offset_deg = 0.0;
};

ByRing by_ring(std::span<const Point> points, std::size_t rings) {
  ByRing lasers(rings);
  const auto returns = test::to_returns(points);
  for (std::size_t i = 0; i < points.size(); ++i) lasers.at(points[i].ring).push_back(returns[i]);
  return lasers;
}

/// The lowest tenth of a laser's returns are above this height.
double floor_m(std::vector<Return> returns) {
  const auto tenth = returns.begin() + static_cast<std::ptrdiff_t>(returns.size() / 10);
  std::ranges::nth_element(returns, tenth, {}, &Return::height_m);
  return tenth->height_m;
}

TEST(HeliosRealData, TheFloorIsFlatOnlyIfTheUnitHas32Lasers) {
  LANDFIX_REAL_DATA(capture, "helios16p/capture.pcap");
  const auto packets = recorded(capture);
  const auto as_32 = decode(AnyDecoder(robosense::Decoder(robosense::kHelios32, {}, {})), packets);
  const auto as_16 = decode(make_decoder(*find_sensor_model("helios16p"), {}), packets);
  ASSERT_EQ(as_32.size(), 6U);
  const auto points_32 = points_of(as_32);
  const ByRing lasers = by_ring(points_32, 32);
  double lowest_m = 0.0;
  double highest_m = -10.0;
  for (std::size_t ring = 0; ring < 9; ++ring) {  // 31 deg down and more
    const double height_m = floor_m(lasers[ring]);
    lowest_m = std::min(lowest_m, height_m);
    highest_m = std::max(highest_m, height_m);
  }
  std::cout << "floor of the nine lowest of 32 lasers: " << lowest_m << " to " << highest_m << " m\n";
  EXPECT_LT(highest_m - lowest_m, 0.04);
  EXPECT_NEAR(lowest_m, -0.69, 0.02);
  // Read as 16 lasers, nothing looks so far down that it could see the floor beside the sensor, and yet
  // returns come back from there at the ranges of a floor: they are spread over all heights.
  const auto points_16 = points_of(as_16);
  EXPECT_EQ(points_16.size(), points_32.size());
  const ByRing halves = by_ring(points_16, 16);
  double lowest_16_m = 0.0;
  double highest_16_m = -10.0;
  for (std::size_t ring = 0; ring < 8; ++ring) {
    lowest_16_m = std::min(lowest_16_m, floor_m(halves[ring]));
    highest_16_m = std::max(highest_16_m, floor_m(halves[ring]));
  }
  std::cout << "the lowest eight of 16: " << lowest_16_m << " to " << highest_16_m << " m\n";
  EXPECT_GT(highest_16_m - lowest_16_m, 0.05);
}

/// How far neighbouring lasers disagree about the azimuth of the same walls, when each laser's azimuth offset
/// is taken `times` times.
double misalignment_rms_deg(std::span<const LaserReturns> lasers, double times) {
  std::vector<Profile> profiles;
  for (const LaserReturns& laser : lasers) {
    Profile& profile = profiles.emplace_back();
    for (const Return& r : laser.returns) {
      if (r.range_m < 0.8) continue;  // the shroud around the sensor
      const double azimuth_deg = r.azimuth_deg + (times - 1.0) * laser.azimuth_offset_deg;
      profile[std::remainder(azimuth_deg, 360.0)] =
          std::sqrt(r.range_m * r.range_m - r.height_m * r.height_m);
    }
  }
  double squares = 0.0;
  int pairs = 0;
  for (std::size_t i = 0; i + 1 < profiles.size(); ++i) {
    const auto apart_deg = test::best_shift_deg(profiles[i], profiles[i + 1], 80, 0.2, 50);
    if (!apart_deg) continue;
    squares += *apart_deg * *apart_deg;
    ++pairs;
  }
  EXPECT_GE(pairs, 6);
  return std::sqrt(squares / std::max(pairs, 1));
}

TEST(HeliosRealData, NeighbouringLasersAgreeOnTheWallsWithTheirAzimuthOffsets) {
  LANDFIX_REAL_DATA(capture, "helios16p/capture.pcap");
  const auto packets = recorded(capture);
  const auto sweeps =
      decode(AnyDecoder(robosense::Decoder(robosense::kHelios32, {}, {.optical_centre = false})), packets);
  robosense::DeviceInfo unit;
  ASSERT_EQ(read_device_info(robosense::kHelios32, packets[0].payload, unit), DecodeStatus::telemetry);
  ASSERT_TRUE(unit.angles);
  // Slots 10 to 16, 0 to 8 deg down, see walls; their rings go down from 22, and offsets take turns at -4 and
  // +3.6 deg.
  const ByRing by_laser = by_ring(sweeps.at(1).points, 32);
  std::vector<LaserReturns> lasers;
  for (std::size_t slot = 9; slot < 16; ++slot) {
    lasers.push_back({by_laser[31 - slot], (*unit.angles)[slot].azimuth_offset_deg});
  }
  const double with_deg = misalignment_rms_deg(lasers, 1.0);
  const double without_deg = misalignment_rms_deg(lasers, 0.0);
  const double flipped_deg = misalignment_rms_deg(lasers, -1.0);
  std::cout << "misalignment with the azimuth offsets " << with_deg << " deg, without " << without_deg
            << " deg, with their sign flipped " << flipped_deg << " deg\n";
  EXPECT_LT(with_deg, 0.4);
  EXPECT_GT(without_deg, 5.0);
  EXPECT_GT(flipped_deg, without_deg);
}

}  // namespace
}  // namespace landfix::drivers
