#include "tools/simulator/simulation.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "platform/atomic_file.hpp"
#include "platform/pcap_source.hpp"
#include "platform/trajectory.hpp"
#include "support/test_data.hpp"
#include "support/test_route.hpp"

namespace landfix::tools::simulator {
namespace {

const std::vector<std::string> kFiles{"capture.pcap", "truth.tum", "map.pcd", "config.toml", "odometry.log"};

SimulationSummary write(std::uint64_t seed, const std::filesystem::path& folder) {
  return write_drive(Drive(test::route_of(test::kStreetRoute), seed), folder, [](double) {});
}

TEST(Simulation, TheSameSeedGivesTheSameBytesAndAnotherSeedOthers) {
  const test::TemporaryDirectory folder;
  write(5, folder.path() / "first");
  write(5, folder.path() / "again");
  write(6, folder.path() / "other");
  for (const std::string& file : kFiles) {
    const auto first = platform::read_file(folder.path() / "first" / file);
    EXPECT_EQ(first, platform::read_file(folder.path() / "again" / file)) << file;
    EXPECT_NE(first, platform::read_file(folder.path() / "other" / file)) << file;
  }
  // Nothing temporary stays behind.
  const std::filesystem::directory_iterator entries(folder.path() / "first");
  EXPECT_EQ(static_cast<std::size_t>(std::distance(begin(entries), end(entries))), kFiles.size() + 1)
      << "and map_projector_info.yaml, the same for all";
}

TEST(Simulation, APacketIsTheSameWhicheverThreadFiresItAndWhen) {
  const test::TemporaryDirectory folder;
  const Drive drive(test::route_of(test::kStreetRoute), 5);
  write_drive(drive, folder.path(), [](double) {});
  platform::PcapSource capture(folder.path() / "capture.pcap");
  platform::UdpPacket packet;
  for (std::size_t number = 0; number < 3000;) {
    ASSERT_EQ(capture.next(packet), platform::ReadStatus::packet);
    if (packet.destination_port != 2368) continue;
    if (number % 100 == 7) {
      const auto alone = drive.lidar().encode(number, drive.packet_utc_ns(number), drive.fire(number));
      ASSERT_TRUE(std::ranges::equal(packet.payload, alone)) << number;
    }
    ++number;
  }
}

TEST(Simulation, TheTruthCoversTheCaptureAndTheRoute) {
  const test::TemporaryDirectory folder;
  const SimulationSummary summary = write(5, folder.path());
  const std::vector<platform::StampedPose> truth = platform::read_tum(folder.path() / "truth.tum");
  double driven_m = 0.0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    driven_m += (truth[i].pose.translation() - truth[i - 1].pose.translation()).norm();
    ASSERT_EQ(truth[i].stamp_utc_ns - truth[i - 1].stamp_utc_ns, 10'000'000);
  }
  EXPECT_NEAR(driven_m, 28.0, 0.1);

  platform::PcapSource capture(folder.path() / "capture.pcap");
  platform::UdpPacket packet;
  std::size_t data = 0;
  std::size_t position = 0;
  std::int64_t last_utc_ns = 0;
  while (capture.next(packet) == platform::ReadStatus::packet) {
    // The first firing is a packet's length before its receipt.
    EXPECT_LT(truth.front().stamp_utc_ns, packet.receive_utc_ns - 2'000'000);
    EXPECT_GT(packet.receive_utc_ns, last_utc_ns);
    last_utc_ns = packet.receive_utc_ns;
    EXPECT_EQ(packet.source_address, 0xC0A801C9U);
    if (packet.destination_port == 2368) {
      EXPECT_EQ(packet.payload.size(), 1206U);
      ++data;
    } else {
      EXPECT_EQ(packet.destination_port, 8308);
      EXPECT_EQ(packet.payload.size(), 512U);
      ++position;
    }
  }
  EXPECT_GT(truth.back().stamp_utc_ns, last_utc_ns);
  EXPECT_EQ(data, summary.data_packets);
  EXPECT_EQ(position, summary.telemetry_packets);
  EXPECT_NEAR(static_cast<double>(data), summary.duration_s * 753.52, 2.0);
  EXPECT_NEAR(static_cast<double>(position), summary.duration_s, 1.0);
}

}  // namespace
}  // namespace landfix::tools::simulator
