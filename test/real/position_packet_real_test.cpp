// Position packets as two cars recorded them.
#include <algorithm>
#include <iostream>
#include <limits>

#include <gtest/gtest.h>

#include "drivers/velodyne/position_packet.hpp"
#include "real/cloud_comparison.hpp"
#include "support/test_data.hpp"

namespace landfix::drivers {
namespace {

TEST(PositionPacketRealData, SaysWhereTheMovingCarIsAndWhatTimeItIs) {
  LANDFIX_REAL_DATA(capture, "vlp16/moving.pcap");
  const auto packets = test::read_packets(capture, 8308);
  ASSERT_EQ(packets.size(), 56U);
  std::int64_t last_ns = 0;
  std::int64_t earliest_ns = std::numeric_limits<std::int64_t>::max();  // of receipt - sensor
  std::int64_t latest_ns = std::numeric_limits<std::int64_t>::min();
  for (const auto& recorded : packets) {
    const auto packet = velodyne::parse_position_packet(recorded.payload);
    ASSERT_TRUE(packet && packet->utc_ns && packet->fix);
    EXPECT_EQ(packet->pulse, velodyne::PulseState::locked);
    EXPECT_NEAR(packet->fix->latitude_deg, 37.1303, 0.001);
    EXPECT_NEAR(packet->fix->longitude_deg, -121.6545, 0.001);
    EXPECT_NEAR(packet->fix->speed_mps, 5.3, 0.2);
    EXPECT_GT(*packet->utc_ns, last_ns);
    last_ns = *packet->utc_ns;
    earliest_ns = std::min(earliest_ns, recorded.receive_utc_ns - *packet->utc_ns);
    latest_ns = std::max(latest_ns, recorded.receive_utc_ns - *packet->utc_ns);
    // The computer's clock was right to a second or so.
    EXPECT_LT(std::abs(*packet->utc_ns - recorded.receive_utc_ns), 2'000'000'000);
  }
  std::cout << "delays differ by " << (latest_ns - earliest_ns) / 1000 << " us\n";
  EXPECT_LT(latest_ns - earliest_ns, 1'000'000) << "the clock advances as the capture's does";
}

TEST(PositionPacketRealData, MayHaveNoReceiver) {
  LANDFIX_REAL_DATA(capture, "hdl32e/capture.pcap");
  const auto packets = test::read_packets(capture, 8308);
  ASSERT_EQ(packets.size(), 65U);
  for (const auto& recorded : packets) {
    const auto packet = velodyne::parse_position_packet(recorded.payload);
    ASSERT_TRUE(packet);
    EXPECT_FALSE(packet->utc_ns);
    EXPECT_FALSE(packet->fix);
  }
}

}  // namespace
}  // namespace landfix::drivers
