#include "platform/udp_receiver.hpp"

#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/heap_counter.hpp"
#include "platform/monotonic_clock.hpp"
#include "platform/nanoseconds.hpp"
#include "support/error_of.hpp"
#include "support/frames.hpp"
#include "support/udp_sender.hpp"

namespace landfix::platform {
namespace {

using namespace landfix::test;
using testing::HasSubstr;

constexpr std::size_t kSlot_bytes = 1248;
constexpr std::uint32_t kHost = loopback(1);
constexpr std::uint32_t kSensor = loopback(1);
constexpr std::uint32_t kStranger = loopback(2);

std::int64_t in_a_moment() { return monotonic_ns() + 20'000'000; }

/// Receives until there is nothing more.
void receive_all(UdpReceiver& receiver, PacketRing& ring) {
  while (receiver.receive(ring, in_a_moment()) == ReceiveStatus::packets) {
  }
}

Bytes taken(PacketRing& ring) {
  const auto payload = ring.front().payload;
  Bytes result(payload.begin(), payload.end());
  ring.free();
  return result;
}

TEST(UdpReceiver, PutsPacketsIntoTheRingAsTheyCame) {
  UdpReceiver receiver({.ports = {0, 0}});
  PacketRing ring(kSlot_bytes, 256);
  UdpSender sender(kSensor);
  std::vector<Bytes> sent;
  for (unsigned i = 0; i < 100; ++i) {
    sent.push_back(payload(i == 7 ? 0 : 1000 + i, i));
    ASSERT_TRUE(sender.send(kHost, receiver.port(0), sent.back()));
  }
  receive_all(receiver, ring);
  ASSERT_TRUE(sender.send(kHost, receiver.port(1), sent[0]));
  receive_all(receiver, ring);

  ASSERT_EQ(ring.waiting(101), 101U);
  for (const Bytes& packet : sent) {
    EXPECT_EQ(ring.header().destination_port, receiver.port(0));
    EXPECT_EQ(ring.header().source_address, kSensor);
    EXPECT_NE(ring.header().source_port, 0);
    ASSERT_EQ(taken(ring), packet);
  }
  EXPECT_EQ(ring.header().destination_port, receiver.port(1));
  EXPECT_EQ(receiver.counters().packets, 101U);
  EXPECT_EQ(receiver.counters().bytes, 1000U * 101 - 1007 + 99 * 100 / 2);
}

TEST(UdpReceiver, StampsAPacketByBothClocksWhenTheKernelHadIt) {
  UdpReceiver receiver({.ports = {0}});
  PacketRing ring(kSlot_bytes, 4);
  const std::int64_t before_ns = monotonic_ns();
  ASSERT_TRUE(UdpSender(kSensor).send(kHost, receiver.port(0), payload(10)));
  const std::int64_t sent_ns = monotonic_ns();
  receive_all(receiver, ring);
  ASSERT_EQ(ring.waiting(1), 1U);
  const PacketHeader& header = ring.header();
  EXPECT_GE(header.arrived_mono_ns, before_ns - 1'000'000);  // two clocks are read one after the other
  EXPECT_LE(header.arrived_mono_ns, header.taken_mono_ns);
  EXPECT_GE(header.taken_mono_ns, sent_ns);
  EXPECT_GT(header.receive_utc_ns, 1'700'000'000 * kNs_per_s);
}

TEST(UdpReceiver, WaitsForNothingUntilTheDeadline) {
  UdpReceiver receiver({.ports = {0}});
  PacketRing ring(kSlot_bytes, 4);
  const std::int64_t deadline_ns = in_a_moment();
  EXPECT_EQ(receiver.receive(ring, deadline_ns), ReceiveStatus::nothing);
  EXPECT_GE(monotonic_ns(), deadline_ns);
}

TEST(UdpReceiver, DropsWhatIsLargerThanASlotAndKeepsItsNeighbours) {
  UdpReceiver receiver({.ports = {0}});
  PacketRing ring(kSlot_bytes, 8);
  UdpSender sender(kSensor);
  for (const std::size_t size : {kSlot_bytes, kSlot_bytes + 1, std::size_t{30'000}, std::size_t{20}}) {
    ASSERT_TRUE(sender.send(kHost, receiver.port(0), payload(size)));
  }
  receive_all(receiver, ring);
  EXPECT_EQ(receiver.counters().truncated, 2U);
  ASSERT_EQ(ring.waiting(3), 2U);
  EXPECT_EQ(taken(ring), payload(kSlot_bytes));
  EXPECT_EQ(taken(ring), payload(20));
}

TEST(UdpReceiver, DropsAndCountsWhatComesWhileTheRingIsFull) {
  UdpReceiver receiver({.ports = {0}});
  PacketRing ring(kSlot_bytes, 8);
  UdpSender sender(kSensor);
  for (unsigned i = 0; i < 50; ++i) ASSERT_TRUE(sender.send(kHost, receiver.port(0), payload(100, i)));
  receive_all(receiver, ring);
  receive_all(receiver, ring);
  EXPECT_EQ(receiver.counters().packets, 8U);
  EXPECT_EQ(receiver.counters().dropped_ring_full, 42U);
  for (unsigned i = 0; i < 8; ++i) EXPECT_EQ(taken(ring), payload(100, i));
  ASSERT_TRUE(sender.send(kHost, receiver.port(0), payload(100, 99)));
  receive_all(receiver, ring);
  EXPECT_EQ(taken(ring), payload(100, 99));
}

/// Sends more than the kernel's buffer holds; the packet after them brings the news.
void overflow(UdpReceiver& receiver, PacketRing& ring, UdpSender& sender, std::uint32_t to) {
  constexpr unsigned kSent = 2000;
  for (unsigned i = 0; i < kSent; ++i) ASSERT_TRUE(sender.send(to, receiver.port(0), payload(1206)));
  receive_all(receiver, ring);
  EXPECT_EQ(receiver.counters().dropped_by_kernel, 0U);
  ASSERT_TRUE(sender.send(to, receiver.port(0), payload(1206)));
  receive_all(receiver, ring);
  EXPECT_GT(receiver.counters().dropped_by_kernel, 0U);
  EXPECT_EQ(receiver.counters().packets + receiver.counters().dropped_by_kernel, kSent + 1);
}

TEST(UdpReceiver, CountsWhatTheKernelDroppedForWantOfRoom) {
  for (const std::uint32_t sensor : {std::uint32_t{0}, kSensor}) {
    UdpReceiver receiver({.ports = {0}, .sensor_address = sensor, .receive_buffer_bytes = 300'000});
    PacketRing ring(kSlot_bytes, 4096);
    UdpSender sender(kSensor);
    overflow(receiver, ring, sender, kHost);
    EXPECT_EQ(receiver.counters().strangers, 0U);
  }
}

TEST(UdpReceiver, CountsStrangersAndKeepsThemOut) {
  UdpReceiver receiver({.ports = {0, 0}, .sensor_address = kSensor});
  PacketRing ring(kSlot_bytes, 64);
  UdpSender sensor(kSensor);
  UdpSender stranger(kStranger);
  for (std::size_t port = 0; port < 2; ++port) {
    for (unsigned i = 0; i < 5; ++i) {
      ASSERT_TRUE(stranger.send(kHost, receiver.port(port), payload(1206, 1)));
      ASSERT_TRUE(sensor.send(kHost, receiver.port(port), payload(1206, 2)));
    }
  }
  receive_all(receiver, ring);
  EXPECT_EQ(receiver.counters().packets, 10U);
  EXPECT_EQ(receiver.counters().strangers, 10U);
  EXPECT_EQ(receiver.counters().dropped_by_kernel, 0U);
  for (unsigned i = 0; i < 10; ++i) {
    EXPECT_EQ(ring.header().source_address, kSensor);
    EXPECT_EQ(taken(ring), payload(1206, 2));
  }
}

TEST(UdpReceiver, LosesNothingOfTheSensorInAFloodFromElsewhere) {
  // GIVEN a flood that would fill the sensor's buffer many times over
  constexpr unsigned kFlood = 50'000;
  constexpr unsigned kPackets = 100;
  UdpReceiver receiver({.ports = {0}, .sensor_address = kSensor, .receive_buffer_bytes = 1'000'000});
  PacketRing ring(kSlot_bytes, 256);
  UdpSender sensor(kSensor);
  UdpSender stranger(kStranger);
  for (unsigned i = 0; i < kFlood; ++i) {
    ASSERT_TRUE(stranger.send(kHost, receiver.port(0), payload(8)));
    if (i % (kFlood / kPackets) == 0) {
      ASSERT_TRUE(sensor.send(kHost, receiver.port(0), payload(1206, i)));
    }
  }
  // WHEN only then it is read, a share of the flood a call
  const auto read = [&] {
    for (int i = 0; i < 50; ++i) static_cast<void>(receiver.receive(ring, 0));
  };
  read();
  ASSERT_TRUE(stranger.send(kHost, receiver.port(0), payload(8)));  // brings the count of those before
  read();
  // THEN every packet of the sensor is there, and every other is counted
  EXPECT_EQ(receiver.counters().packets, kPackets);
  EXPECT_EQ(receiver.counters().dropped_by_kernel, 0U);
  EXPECT_EQ(receiver.counters().strangers, kFlood + 1);
}

TEST(UdpReceiver, HearsBroadcastsAndTellsThoseOfStrangersFromLosses) {
  constexpr std::uint32_t kBroadcast = 0x7FFFFFFF;
  UdpReceiver receiver({.ports = {0}, .sensor_address = kSensor});
  PacketRing ring(kSlot_bytes, 256);
  UdpSender sensor(kSensor);
  UdpSender stranger(kStranger);
  for (unsigned i = 0; i < 100; ++i) {
    if (!sensor.send(kBroadcast, receiver.port(0), payload(1206, 2))) GTEST_SKIP() << "no broadcast here";
    ASSERT_TRUE(stranger.send(kBroadcast, receiver.port(0), payload(1206, 1)));
    if (i % 10 == 0) static_cast<void>(receiver.receive(ring, 0));
  }
  ASSERT_TRUE(sensor.send(kBroadcast, receiver.port(0), payload(1206, 2)));
  receive_all(receiver, ring);
  EXPECT_EQ(receiver.counters().packets, 101U);
  EXPECT_EQ(receiver.counters().strangers, 100U);
  EXPECT_EQ(receiver.counters().dropped_by_kernel, 0U);
  while (ring.waiting(1) != 0) EXPECT_EQ(taken(ring), payload(1206, 2));
}

TEST(UdpReceiver, CountsLostBroadcastsOfTheSensor) {
  UdpReceiver receiver({.ports = {0}, .sensor_address = kSensor, .receive_buffer_bytes = 300'000});
  PacketRing ring(kSlot_bytes, 4096);
  UdpSender sender(kSensor);
  if (!sender.send(0x7FFFFFFF, receiver.port(0) == 1 ? 2 : 1, payload(1)))
    GTEST_SKIP() << "no broadcast here";
  overflow(receiver, ring, sender, 0x7FFFFFFF);
}

TEST(UdpReceiver, JoinsAMulticastGroup) {
  constexpr std::uint32_t kGroup = 0xEFFF0001;
  for (const std::uint32_t address : {std::uint32_t{0}, kSensor}) {
    UdpReceiver receiver({.ports = {0},
                          .sensor_address = address,
                          .multicast_group = kGroup,
                          .interface_address = loopback(1)});
    PacketRing ring(kSlot_bytes, 16);
    UdpSender sensor(kSensor);
    UdpSender stranger(kStranger);
    if (!sensor.send(kGroup, receiver.port(0), payload(1206))) GTEST_SKIP() << "no multicast here";
    ASSERT_TRUE(stranger.send(kGroup, receiver.port(0), payload(1206, 1)));
    ASSERT_TRUE(sensor.send(kHost, receiver.port(0), payload(1206, 2)));  // to this computer, not the group
    receive_all(receiver, ring);
    EXPECT_EQ(receiver.counters().packets, address == 0 ? 2U : 1U);
    EXPECT_EQ(receiver.counters().strangers, address == 0 ? 0U : 1U);
    EXPECT_EQ(taken(ring), payload(1206));
  }
}

TEST(UdpReceiver, RefusesAPortThatAnotherProgramHas) {
  for (const std::uint32_t address : {std::uint32_t{0}, kSensor}) {
    const UdpReceiver first({.ports = {0}, .sensor_address = address});
    EXPECT_THAT(
        error_of([&] { return UdpReceiver({.ports = {first.port(0)}, .sensor_address = kSensor}).port(0); }),
        HasSubstr("stop the program that does"));
  }
}

TEST(UdpReceiver, SaysWhatItCouldNotHave) {
  const UdpReceiver modest({.ports = {0}, .receive_buffer_bytes = 100'000});
  EXPECT_TRUE(modest.warnings().empty());
  const UdpReceiver lost({.ports = {0}, .multicast_group = 0xEFFF0001, .interface_address = 0xCB007101});
  ASSERT_FALSE(lost.warnings().empty());
  EXPECT_THAT(lost.warnings().back(), HasSubstr("no interface for the multicast group 239.255.0.1 yet"));
}

TEST(UdpReceiver, WaitsForAnInterfaceWhoseAddressIsYetToCome) {
  const UdpReceiver receiver({.ports = {0}, .interface_address = 0xCB007101});  // 203.0.113.1, nobody's
  EXPECT_NE(receiver.port(0), 0);
}

TEST(UdpReceiver, ReceivesWithoutTheHeap) {
  if (!HeapCounter::available()) GTEST_SKIP() << "the heap cannot be counted: a sanitizer, or not glibc";
  UdpReceiver receiver({.ports = {0, 0}, .sensor_address = kSensor, .receive_buffer_bytes = 300'000});
  PacketRing ring(kSlot_bytes, 64);
  UdpSender sensor(kSensor);
  UdpSender stranger(kStranger);
  for (unsigned i = 0; i < 300; ++i) {
    ASSERT_TRUE(sensor.send(kHost, receiver.port(i % 2), payload(i * 10)));
    ASSERT_TRUE(stranger.send(kHost, receiver.port(i % 2), payload(10)));
  }
  const std::uint64_t before = HeapCounter::calls();
  HeapCounter::arm();
  receive_all(receiver, ring);
  receive_all(receiver, ring);
  HeapCounter::disarm();
  EXPECT_EQ(HeapCounter::calls(), before);
  EXPECT_GT(receiver.counters().dropped_ring_full, 0U);
}

TEST(UdpReceiver, HandsPacketsToAnotherThread) {
  UdpReceiver receiver({.ports = {0}, .sensor_address = kSensor});
  PacketRing ring(kSlot_bytes, 64);
  constexpr unsigned kPackets = 2000;
  std::atomic<bool> is_over = false;
  std::thread rx([&] {
    while (!is_over.load(std::memory_order_relaxed)) static_cast<void>(receiver.receive(ring, in_a_moment()));
  });
  UdpSender sensor(kSensor);
  for (unsigned i = 0; i < kPackets; ++i) {
    ASSERT_TRUE(sensor.send(kHost, receiver.port(0), payload(200, i)));
    while (ring.waiting(1) == 0) std::this_thread::yield();
    ASSERT_EQ(taken(ring), payload(200, i));
    EXPECT_EQ(receiver.counters().dropped_by_kernel, 0U);
  }
  is_over.store(true, std::memory_order_relaxed);
  rx.join();
  EXPECT_EQ(receiver.counters().packets, kPackets);
}

}  // namespace
}  // namespace landfix::platform
