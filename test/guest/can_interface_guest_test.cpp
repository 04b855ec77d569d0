// Real interfaces of CAN, as the guest has them: vcan0 and vcan1.
#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "guest/guest_commands.hpp"
#include "platform/can_receiver.hpp"
#include "platform/candump_log.hpp"
#include "platform/monotonic_clock.hpp"
#include "platform/pose_frame_decoder.hpp"
#include "platform/pose_frames.hpp"
#include "platform/socket_can.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

using test::run;

constexpr std::int64_t kMs_ns = 1'000'000;
constexpr std::uint32_t kBaseId = 0x3A0;
constexpr std::int64_t kBegin_utc_ns = 1'700'000'000'000'000'000;

void wait_ms(int duration_ms) { std::this_thread::sleep_for(std::chrono::milliseconds(duration_ms)); }

PoseReport report_at(int number) {
  PoseReport report;
  report.stamp_utc_ns = kBegin_utc_ns + number * 100 * kMs_ns;
  report.x_m = number;
  report.state = 5;
  return report;
}

std::vector<CanFrame> receive_all(CanReceiver& receiver, int patience = 3) {
  std::vector<CanFrame> frames;
  CanFrame frame;
  std::int64_t stamp_utc_ns = 0;
  // What was sent is there: vcan delivers on one processor before the sender goes on, on several soon after.
  for (int quiet = 0; quiet <= patience; ++quiet) {
    if (quiet != 0) wait_ms(10);
    for (; receiver.receive(frame, stamp_utc_ns); quiet = 0) frames.push_back(frame);
  }
  return frames;
}

std::vector<CanFrame> frames_of_log(const std::filesystem::path& path) {
  std::vector<CanFrame> frames;
  std::ifstream log(path);
  for (std::string line; std::getline(log, line);) {
    if (const auto logged = parse_candump_line(line)) frames.push_back(logged->frame);
  }
  return frames;
}

/// Waits until a program that was started listens: its frames would be lost before.
void wait_until_listening(SocketCan& bus, const std::filesystem::path& log) {
  const CanFrame probe{.id = 0x001, .length = 1};
  for (int i = 0; i < 500 && frames_of_log(log).empty(); ++i) {
    (void)bus.send(std::span(&probe, 1), 0);
    wait_ms(20);
  }
}

class CanInterface : public testing::Test {
 protected:
  void SetUp() override {
    if (SocketCan("vcan0", false).status().state == BusState::missing)
      GTEST_SKIP() << "no vcan0 here: ./check can";
  }
  void TearDown() override { (void)std::system("tc qdisc del dev vcan0 root 2>/dev/null"); }

  /// Sends poses; every one must come out of the decoder whole, and candump must have seen the same frames.
  void expect_poses_arrive(bool fd) {
    constexpr int kPoses = 100;
    const auto log = directory_.path() / "candump.log";
    SocketCan bus("vcan0", fd);
    test::Background candump("stdbuf -oL candump -L vcan0,3A0:7F0 vcan0,001:7FF >" + log.string());
    wait_until_listening(bus, log);
    CanReceiver receiver("vcan0", std::array{CanId{kBaseId + 99}});
    CanReceiver all("vcan0", {});
    PoseFrameEncoder encoder(kBaseId, fd);
    std::vector<CanFrame> sent;
    std::vector<CanFrame> received;
    for (int i = 0; i < kPoses; ++i) {
      const PoseFrames frames = encoder.encode(report_at(i));
      ASSERT_EQ(bus.send(frames.all(), 0), frames.count);
      sent.insert(sent.end(), frames.all().begin(), frames.all().end());
      wait_ms(1);
      for (const CanFrame& frame : receive_all(all, 0)) received.push_back(frame);
    }
    for (const CanFrame& frame : receive_all(all)) received.push_back(frame);
    EXPECT_TRUE(received == sent) << received.size() << " frames of " << sent.size();
    EXPECT_TRUE(receive_all(receiver).empty());

    PoseFrameDecoder decoder(kBaseId);
    int poses = 0;
    for (const CanFrame& frame : received) {
      const DecodedFrame decoded = decoder.decode(frame, 0);
      EXPECT_FALSE(decoded.has_fault());
      if (decoded.pose) {
        EXPECT_EQ(decoded.pose->x_m, poses++);
      }
    }
    EXPECT_EQ(poses, kPoses);

    std::vector<CanFrame> dumped = frames_of_log(log);
    for (int i = 0; i < 200 && dumped.size() < sent.size(); ++i) {
      wait_ms(20);
      dumped = frames_of_log(log);
    }
    std::erase_if(dumped, [](const CanFrame& frame) { return frame.id == 0x001; });
    EXPECT_TRUE(dumped == sent) << dumped.size() << " frames of " << sent.size();
    EXPECT_EQ(bus.status().dropped_queue_full + bus.status().dropped_bus_down, 0U);
  }

  test::TemporaryDirectory directory_;
};

TEST_F(CanInterface, PosesArriveInOrderAndProtected) { expect_poses_arrive(false); }

TEST_F(CanInterface, PosesArriveAsCanFd) { expect_poses_arrive(true); }

TEST_F(CanInterface, AQueueOfFourFramesOverflowsAndRecovers) {
  run("tc qdisc add dev vcan0 root netem delay 30ms limit 4");
  SocketCan bus("vcan0", false);
  CanReceiver receiver("vcan0", {});
  std::array<CanFrame, 6> group;
  for (std::uint32_t i = 0; i < group.size(); ++i) group[i] = {.id = kBaseId + i, .length = 8};
  EXPECT_EQ(bus.send(group, 0), 4U);
  EXPECT_EQ(bus.send(group, 0), 0U);
  EXPECT_EQ(bus.status().frames_sent, 4U);
  EXPECT_EQ(bus.status().dropped_queue_full, 2U + 6U);
  EXPECT_EQ(bus.status().state, BusState::up);
  wait_ms(100);
  EXPECT_EQ(receive_all(receiver).size(), 4U);
  EXPECT_EQ(bus.send(std::span(group).first(4), 0), 4U);
  wait_ms(100);
  EXPECT_EQ(receive_all(receiver).size(), 4U);
}

TEST_F(CanInterface, DownAndUpRecoversAtTheNextPose) {
  SocketCan bus("vcan0", false);
  CanReceiver receiver("vcan0", {});
  const CanFrame frame{.id = kBaseId, .length = 8};
  const auto send = [&] { return bus.send(std::span(&frame, 1), 0); };
  EXPECT_EQ(send(), 1U);
  run("ip link set vcan0 down");
  EXPECT_EQ(send(), 0U);
  EXPECT_EQ(bus.status().state, BusState::down);
  EXPECT_EQ(bus.status().dropped_bus_down, 1U);
  run("ip link set vcan0 up");
  std::int64_t monotonic_ns = 0;
  bus.maintain(monotonic_ns += CanPort::kPeriod_ns);
  EXPECT_EQ(bus.status().state, BusState::up);
  EXPECT_EQ(send(), 1U);
  receiver.maintain(monotonic_ns);
  EXPECT_EQ(receive_all(receiver).size(), 2U);

  // Between two poses: neither may be lost.
  run("ip link set vcan0 down; ip link set vcan0 up");
  bus.maintain(monotonic_ns += CanPort::kPeriod_ns);
  EXPECT_EQ(send(), 1U);
  EXPECT_EQ(bus.status().times_lost, 0U);
}

TEST_F(CanInterface, DeletedAndCreatedAgainRecovers) {
  SocketCan bus("vcan1", true);
  CanReceiver receiver("vcan1", std::array{CanId{kBaseId}});
  const CanFrame frame{.id = kBaseId, .fd = true, .length = 64};
  const auto send = [&] { return bus.send(std::span(&frame, 1), 0); };
  std::int64_t monotonic_ns = 0;
  const auto maintain = [&] {
    monotonic_ns += CanPort::kPeriod_ns;
    bus.maintain(monotonic_ns);
    receiver.maintain(monotonic_ns);
  };
  EXPECT_EQ(send(), 1U);
  run("ip link del vcan1");
  EXPECT_EQ(send(), 0U);
  maintain();
  EXPECT_EQ(bus.status().state, BusState::missing);
  EXPECT_EQ(bus.status().error, ENODEV);
  EXPECT_EQ(receiver.state(), BusState::missing);
  EXPECT_EQ(send(), 0U);
  EXPECT_EQ(bus.status().dropped_bus_down, 2U);

  // Set to classic CAN first: no use for CAN FD.
  run("ip link add vcan1 type vcan; ip link set vcan1 mtu 16 up");
  maintain();
  EXPECT_EQ(bus.status().state, BusState::missing);
  EXPECT_EQ(bus.status().error, EMSGSIZE);
  run("ip link set vcan1 down; ip link set vcan1 mtu 72 up");
  maintain();
  EXPECT_EQ(bus.status().state, BusState::up);
  EXPECT_EQ(receiver.state(), BusState::up);
  EXPECT_EQ(send(), 1U);
  EXPECT_EQ(receive_all(receiver).size(), 1U);
  EXPECT_EQ(bus.status().times_lost, 1U);

  // Between two poses; the new one has another index.
  run("ip link del vcan1; ip link add vcan1 type vcan; ip link set vcan1 mtu 72 up");
  maintain();
  EXPECT_EQ(send(), 1U);
  EXPECT_EQ(receive_all(receiver).size(), 1U);
}

TEST_F(CanInterface, TenPosesASecondAreBackWithinOne) {
  struct Loss {
    const char* away;
    const char* back;
  };
  SocketCan bus("vcan0", false);
  const CanFrame frame{.id = kBaseId, .length = 8};
  const auto send_pose = [&] {
    bus.maintain(monotonic_ns());
    const bool is_sent = bus.send(std::span(&frame, 1), 0) == 1;
    wait_ms(100);
    return is_sent;
  };
  for (const Loss& loss :
       {Loss{"ip link set vcan0 down", "ip link set vcan0 up"},
        Loss{"ip link del vcan0", "ip link add vcan0 type vcan; ip link set vcan0 mtu 72 up"}}) {
    run(loss.away);
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(send_pose());
    run(loss.back);
    const std::int64_t began_ns = monotonic_ns();
    int poses_lost = 0;
    while (!send_pose()) ASSERT_LT(++poses_lost, 10) << "no pose for a second";
    fmt::print("{}, {}: {} poses lost, the next was sent within {:.0f} ms\n", loss.away, loss.back,
               poses_lost, static_cast<double>(monotonic_ns() - began_ns) * 1e-6 - 100.0);
  }
}

TEST_F(CanInterface, TheKernelLetsTheWantedIdentifiersThroughAlone) {
  SocketCan bus("vcan0", true);
  CanReceiver receiver("vcan0", std::array{CanId{0x0B2}, CanId{0x12345, true}});
  const std::array frames{
      CanFrame{.id = 0x0B2, .length = 8},
      CanFrame{.id = 0x0B3, .length = 8},
      CanFrame{.id = 0x0B2, .extended = true, .length = 8},
      CanFrame{.id = 0x12345, .extended = true, .length = 8},
      CanFrame{.id = 0x345, .length = 8},
      CanFrame{.id = 0x0B2, .fd = true, .length = 12},
  };
  ASSERT_EQ(bus.send(frames, 0), frames.size());
  EXPECT_EQ(receive_all(receiver), (std::vector{frames[0], frames[3], frames[5]}));
}

TEST_F(CanInterface, CanplayerReplaysALogWithTheKernelsTimes) {
  constexpr int kFrames = 50;
  const auto path = directory_.path() / "odometry.log";
  CandumpLog log(path, "can0");
  for (int i = 0; i < kFrames; ++i) {
    const CanFrame frame{.id = 0x0B2, .length = 8, .data = {static_cast<std::byte>(i)}};
    ASSERT_EQ(log.send(std::span(&frame, 1), kBegin_utc_ns + i * 10 * kMs_ns), 1U);
  }
  log.commit();
  CanReceiver receiver("vcan0", std::array{CanId{0x0B2}});
  run("canplayer -I " + path.string() + " vcan0=can0");
  CanFrame frame;
  std::int64_t first_utc_ns = 0;
  std::int64_t last_utc_ns = 0;
  for (int i = 0; i < kFrames; ++i) {
    std::int64_t stamp_utc_ns = 0;
    ASSERT_TRUE(receiver.receive(frame, stamp_utc_ns)) << i;
    EXPECT_EQ(frame.data[0], static_cast<std::byte>(i));
    EXPECT_GE(stamp_utc_ns, last_utc_ns);
    if (i == 0) first_utc_ns = stamp_utc_ns;
    last_utc_ns = stamp_utc_ns;
  }
  // They were fetched after the last was sent: the times are the kernel's, not those of the fetching.
  EXPECT_GT(last_utc_ns - first_utc_ns, 49 * 10 * kMs_ns / 2);
}

TEST_F(CanInterface, BusOffAndRestartAreSeen) {
  SocketCan bus("vcan0", false);
  const CanFrame frame{.id = kBaseId, .length = 8};
  run("cansend vcan0 20000004#0020000000000000");
  bus.maintain(0);
  EXPECT_EQ(bus.status().state, BusState::error_passive);
  EXPECT_EQ(bus.send(std::span(&frame, 1), 0), 1U);
  run("cansend vcan0 20000040#0000000000000000");
  bus.maintain(1);
  EXPECT_EQ(bus.status().state, BusState::bus_off);
  EXPECT_EQ(bus.send(std::span(&frame, 1), 0), 0U);
  run("cansend vcan0 20000100#0000000000000000");
  bus.maintain(2);
  EXPECT_EQ(bus.status().state, BusState::up);
  EXPECT_EQ(bus.send(std::span(&frame, 1), 0), 1U);
}

TEST_F(CanInterface, WhatNobodyFetchesIsCounted) {
  SocketCan bus("vcan0", false);
  CanReceiver receiver("vcan0", {});
  const CanFrame frame{.id = kBaseId, .length = 8};
  std::uint64_t sent = 0;
  for (int i = 0; i < 2000; ++i) sent += bus.send(std::span(&frame, 1), 0);
  const auto received = receive_all(receiver);
  EXPECT_LT(received.size(), sent);
  // The kernel tells with a frame how many it dropped before it.
  EXPECT_EQ(bus.send(std::span(&frame, 1), 0), 1U);
  EXPECT_EQ(receive_all(receiver).size(), 1U);
  EXPECT_EQ(received.size() + receiver.frames_overflowed(), sent);
}

}  // namespace
}  // namespace landfix::platform
