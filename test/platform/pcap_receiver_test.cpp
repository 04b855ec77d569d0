#include "platform/pcap_receiver.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/heap_counter.hpp"
#include "platform/monotonic_clock.hpp"
#include "platform/nanoseconds.hpp"
#include "platform/pace.hpp"
#include "platform/pcap_writer.hpp"
#include "support/error_of.hpp"
#include "support/frames.hpp"

namespace landfix::platform {
namespace {

using namespace landfix::test;

constexpr std::int64_t kStart_utc_ns = 1'700'000'000'123'456'789;
constexpr std::int64_t kInterval_ns = 2 * kNs_per_ms;
constexpr UdpFlow kData{.source_address = 0xC0A801C9, .source_port = 2368, .destination_port = 2368};
constexpr UdpFlow kPosition{.source_address = 0xC0A801C9, .source_port = 8308, .destination_port = 8308};
constexpr UdpFlow kStranger{.source_address = 0xC0A801CA, .source_port = 2368, .destination_port = 2368};

std::int64_t in_a_second() { return monotonic_ns() + 1000 * kNs_per_ms; }

class PcapReceiverTest : public testing::Test {
 protected:
  void SetUp() override {
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".pcap");
  }
  void TearDown() override { std::filesystem::remove(path_); }

  /// A packet every interval; the seeds count from 0.
  void write(unsigned count, const UdpFlow& flow = kData) {
    PcapWriter writer(path_);
    for (unsigned i = 0; i < count; ++i)
      writer.write(flow, payload(100, i), kStart_utc_ns + i * kInterval_ns);
    writer.commit();
  }

  std::filesystem::path path_;
};

TEST_F(PcapReceiverTest, DeliversEveryPacketAsFastAsTheyAreTaken) {
  write(100);
  PcapReceiver receiver({.file = path_, .speed = 0.0});
  PacketRing ring(128, 16);
  unsigned next = 0;
  auto status = ReceiveStatus::nothing;
  while ((status = receiver.receive(ring, monotonic_ns() + kNs_per_ms)) != ReceiveStatus::end) {
    if (status == ReceiveStatus::packets && next % 3 != 0) continue;  // so that the ring fills
    while (ring.waiting(1) != 0) {
      EXPECT_EQ(ring.header().receive_utc_ns, kStart_utc_ns + next * kInterval_ns);
      EXPECT_EQ(ring.header().source_address, kData.source_address);
      EXPECT_EQ(ring.header().destination_port, 2368);
      const auto packet = ring.front().payload;
      EXPECT_EQ(Bytes(packet.begin(), packet.end()), payload(100, next++));
      ring.free();
    }
  }
  next += static_cast<unsigned>(ring.waiting(16));
  EXPECT_EQ(next, 100U);
  EXPECT_EQ(receiver.counters().packets, 100U);
  EXPECT_EQ(receiver.counters().bytes, 10'000U);
  EXPECT_EQ(receiver.counters().dropped_ring_full, 0U);
}

TEST_F(PcapReceiverTest, KeepsTheRecordedPace) {
  for (const double speed : {1.0, 2.0}) {
    write(20);
    PcapReceiver receiver({.file = path_, .speed = speed});
    PacketRing ring(128, 32);
    while (receiver.receive(ring, in_a_second()) == ReceiveStatus::packets) {
    }
    ASSERT_EQ(ring.waiting(20), 20U);
    const std::int64_t first_ns = ring.header().arrived_mono_ns;
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(ring.header().arrived_mono_ns - first_ns, paced_ns(i * kInterval_ns, speed));
      EXPECT_GE(ring.header().taken_mono_ns, ring.header().arrived_mono_ns);
      ring.free();
    }
  }
}

TEST_F(PcapReceiverTest, ComesBackAtTheDeadlineWithoutAPacket) {
  PcapWriter writer(path_);
  writer.write(kData, payload(100), kStart_utc_ns);
  writer.write(kData, payload(100), kStart_utc_ns + 1000'000 * kNs_per_ms);
  writer.commit();
  PcapReceiver receiver({.file = path_});
  PacketRing ring(128, 4);
  EXPECT_EQ(receiver.receive(ring, in_a_second()), ReceiveStatus::packets);
  const std::int64_t deadline_ns = monotonic_ns() + kNs_per_ms;
  EXPECT_EQ(receiver.receive(ring, deadline_ns), ReceiveStatus::nothing);
  EXPECT_GE(monotonic_ns(), deadline_ns);
}

TEST_F(PcapReceiverTest, DropsAtAPaceWhatTheRingHasNoRoomFor) {
  write(20);
  PcapReceiver receiver({.file = path_, .speed = 1000.0});
  PacketRing ring(128, 8);
  while (receiver.receive(ring, in_a_second()) != ReceiveStatus::end) {
  }
  EXPECT_EQ(receiver.counters().packets, 8U);
  EXPECT_EQ(receiver.counters().dropped_ring_full, 12U);
}

TEST_F(PcapReceiverTest, CountsWhatItLeavesOut) {
  PcapWriter writer(path_);
  writer.write(kData, payload(100), kStart_utc_ns);
  writer.write(kPosition, payload(100), kStart_utc_ns);
  writer.write(kStranger, payload(100), kStart_utc_ns);
  writer.write(kData, payload(129), kStart_utc_ns);
  writer.commit();
  PcapReceiver receiver({.file = path_, .ports = {2368}, .sensor_address = 0xC0A801C9, .speed = 0.0});
  PacketRing ring(128, 8);
  while (receiver.receive(ring, in_a_second()) != ReceiveStatus::end) {
  }
  EXPECT_EQ(receiver.counters().packets, 1U);
  EXPECT_EQ(receiver.counters().other_ports, 1U);
  EXPECT_EQ(receiver.counters().strangers, 1U);
  EXPECT_EQ(receiver.counters().truncated, 1U);
}

TEST_F(PcapReceiverTest, RunsLapsWithTheirTimesShifted) {
  write(5);
  PcapReceiver receiver({.file = path_, .speed = 0.0, .laps = 3});
  PacketRing ring(128, 32);
  const std::uint64_t before = HeapCounter::calls();
  HeapCounter::arm();
  while (receiver.receive(ring, in_a_second()) != ReceiveStatus::end) {
  }
  HeapCounter::disarm();
  EXPECT_EQ(HeapCounter::calls(), before);
  EXPECT_EQ(receiver.laps_done(), 3U);
  ASSERT_EQ(ring.waiting(16), 15U);
  for (unsigned i = 0; i < 15; ++i) {
    EXPECT_EQ(ring.header().receive_utc_ns, kStart_utc_ns + i * kInterval_ns);
    const auto packet = ring.front().payload;
    EXPECT_EQ(Bytes(packet.begin(), packet.end()), payload(100, i % 5));
    ring.free();
  }
}

TEST_F(PcapReceiverTest, EndsWhereNothingIsKept) {
  write(5, kPosition);
  PcapReceiver receiver({.file = path_, .ports = {2368}, .laps = 1'000'000});
  PacketRing ring(128, 32);
  EXPECT_EQ(receiver.receive(ring, in_a_second()), ReceiveStatus::end);
}

TEST_F(PcapReceiverTest, TellsACaptureThatIsCutOff) {
  write(3);
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 1);
  PcapReceiver receiver({.file = path_, .speed = 0.0});
  PacketRing ring(128, 8);
  EXPECT_EQ(receiver.receive(ring, in_a_second()), ReceiveStatus::packets);
  EXPECT_EQ(receiver.receive(ring, in_a_second()), ReceiveStatus::truncated);
  EXPECT_EQ(receiver.counters().packets, 2U);
}

TEST(Pace, IsTheRecordedOneTimesTheSpeed) {
  EXPECT_EQ(paced_ns(1'000'000'000, 1.0), 1'000'000'000);
  EXPECT_EQ(paced_ns(1'000'000'000, 4.0), 250'000'000);
  EXPECT_EQ(paced_ns(3, 0.5), 6);
  EXPECT_EQ(paced_ns(-1'000, 10.0), -100);  // packets that a capture has out of order
  EXPECT_GT(paced_ns(9'000'000'000'000'000'000, 1e-9), 3'000'000'000'000'000'000);
}

}  // namespace
}  // namespace landfix::platform
