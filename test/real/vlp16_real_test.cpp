// The VLP-16's recorded packets against clouds that others decoded from them.
#include <cstring>
#include <iostream>

#include <gtest/gtest.h>

#include "drivers/little_endian.hpp"
#include "drivers/velodyne/wire.hpp"
#include "real/cloud_comparison.hpp"
#include "support/test_data.hpp"

namespace landfix::drivers {
namespace {

using test::Differences;
using test::RecordedPacket;
using test::Return;
using velodyne::WirePacket;

/// The references leave the vertical offsets out.
constexpr DecoderOptions kAsTheReferences{.vertical_offsets = false};

std::vector<Return> read_dual_reference(const std::filesystem::path& path) {
  constexpr std::string_view kColumns[] = {"x", "y", "z", "intensity"};
  std::vector<Return> returns;
  for (const auto& row : test::read_pcd(path, kColumns)) {
    returns.push_back(test::to_return(row[0], row[1], row[2], row[3]));
  }
  return returns;
}

TEST(Vlp16RealData, AgreesWithTheVendorsViewerOnAMovingCar) {
  LANDFIX_REAL_DATA(capture, "vlp16/moving.pcap");
  LANDFIX_REAL_DATA(reference, "vlp16/moving-sweep.csv");
  const auto packets = test::read_packets(capture, 2368);
  EXPECT_EQ(packets.size(), 291U);
  const auto sweeps = test::decode_sweeps("vlp16", packets, kAsTheReferences);
  const auto theirs = test::to_returns(test::read_viewer_csv(reference));
  ASSERT_GT(sweeps.size(), 1U);
  const auto ours = test::to_returns(sweeps[1].points);
  ASSERT_EQ(ours.size(), theirs.size());
  const Differences most = test::compare(ours, theirs);
  test::print("vlp16", most);
  EXPECT_EQ(most.intensity, 0.0);
  EXPECT_LT(most.range_m, 1e-3);
  EXPECT_LT(most.height_m, 1e-3);
  // The viewer rounds azimuths to 0.01 deg.
  EXPECT_LT(most.azimuth_deg, 0.015);
}

/// A return that the reference of the dual-return capture kept, and the azimuth that it gave it.
struct Kept {
  std::size_t block = 0;
  double azimuth_deg = 0.0;
};

/// The reference's azimuth of one slot. It takes the next pair's azimuth for the second block of a pair, and
/// turns neither those nor the last pair on by their firing times.
double azimuth_of_the_reference(const WirePacket& wire, std::size_t block, std::size_t slot) {
  const auto azimuth = [&](std::size_t b) {
    return static_cast<double>(load_little_endian<std::uint16_t>(wire.blocks[b].azimuth_centideg));
  };
  if (block >= 10) return azimuth(10);
  if (block % 2 == 1) return azimuth(block + 1);
  const double step = std::fmod(azimuth(block + 2) - azimuth(block) + 36000.0, 36000.0);
  const double time_us = 2.304 * static_cast<double>(slot % 16) + 55.296 * static_cast<double>(slot / 16);
  return std::fmod(std::round(azimuth(block) + step * time_us / 110.592), 36000.0);
}

/// Blanks the returns that the reference leaves out, so that what is decoded is its selection: the second of
/// two equal ones, ranges below 0.3 m, azimuths from 359.01 to 359.99 deg, second returns that it places
/// beyond the cut. Appends what is left.
void select_as_the_reference(RecordedPacket& packet, std::vector<Kept>& kept) {
  WirePacket wire;
  ASSERT_EQ(packet.payload.size(), sizeof(wire));
  std::memcpy(&wire, packet.payload.data(), sizeof(wire));
  const WirePacket before = wire;
  for (std::size_t block = 0; block < velodyne::kBlocks; ++block) {
    for (std::size_t slot = 0; slot < velodyne::kBlockSlots; ++slot) {
      const auto range = [&](std::size_t b) {
        return load_little_endian<std::uint16_t>(before.blocks[b].slots + slot * kSlotBytes);
      };
      if (range(block) == 0) continue;
      const double azimuth_centideg = azimuth_of_the_reference(before, block, slot);
      const bool second_of_equals = block % 2 == 1 && range(block) == range(block - 1);
      const double block_centideg = load_little_endian<std::uint16_t>(before.blocks[block].azimuth_centideg);
      const bool in_the_next_sweep = azimuth_centideg < block_centideg - 18000.0;
      const bool dropped =
          second_of_equals || range(block) * 0.002 < 0.3 || azimuth_centideg > 35900.0 || in_the_next_sweep;
      if (dropped) {
        std::memset(wire.blocks[block].slots + slot * kSlotBytes, 0, 2);
      } else {
        kept.push_back({block, azimuth_centideg * 0.01});
      }
    }
  }
  std::memcpy(packet.payload.data(), &wire, sizeof(wire));
}

TEST(Vlp16RealData, AgreesWithTheReferenceOnDualReturns) {
  LANDFIX_REAL_DATA(capture, "vlp16/dual-return.pcap");
  LANDFIX_REAL_DATA(reference, "vlp16/dual-return-sweep.pcd");
  auto packets = test::read_packets(capture, 2368);
  EXPECT_EQ(packets.size(), 603U);
  std::vector<Kept> kept;
  for (RecordedPacket& packet : packets) select_as_the_reference(packet, kept);
  const auto sweeps = test::decode_sweeps("vlp16", packets, kAsTheReferences);
  ASSERT_GT(sweeps.size(), 3U);
  const std::size_t first = sweeps[0].points.size() + sweeps[1].points.size() + sweeps[2].points.size();
  const auto ours = test::to_returns(sweeps[3].points);
  const auto theirs = read_dual_reference(reference);
  ASSERT_EQ(ours.size(), theirs.size());
  const Differences most = test::compare(ours, theirs);
  test::print("vlp16", most);
  EXPECT_EQ(most.intensity, 0.0);
  EXPECT_LT(most.range_m, 1e-3);
  EXPECT_LT(most.height_m, 1e-3);
  EXPECT_LT(most.azimuth_deg, 0.45);
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const Kept& selected = kept[first + i];
    // The reference errs as is known of it, to the last digit;
    ASSERT_LT(test::degrees_apart(theirs[i].azimuth_deg, selected.azimuth_deg), 1e-3) << i;
    // where it does not, only its rounding to 0.01 deg and the encoder's jitter are between us.
    if (selected.block % 2 == 0 && selected.block < 10) {
      EXPECT_LT(test::degrees_apart(ours[i].azimuth_deg, theirs[i].azimuth_deg), 0.025) << i;
    }
  }
}

}  // namespace
}  // namespace landfix::drivers
