#include "platform/socket_can.hpp"

#include <array>
#include <cerrno>

#include <gtest/gtest.h>
#include <linux/can/error.h>

#include "platform/heap_counter.hpp"
#include "support/fake_can.hpp"

namespace landfix::platform {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000;

/// Six frames, as of one pose; told apart by their first byte.
std::array<CanFrame, 6> group_of(unsigned number) {
  std::array<CanFrame, 6> group;
  for (unsigned i = 0; i < group.size(); ++i) {
    group[i] = {.id = 0x3A0 + i, .length = 8, .data = {static_cast<std::byte>(number)}};
  }
  return group;
}

class SocketCanTest : public testing::Test {
 protected:
  void expect_arrived(std::span<const CanFrame> frames) {
    for (const CanFrame& frame : frames) EXPECT_EQ(fake_.take(), frame);
    EXPECT_EQ(fake_.take(), std::nullopt);
  }
  /// Sends groups until one does not fit; how many frames went in.
  std::size_t fill_queue(SocketCan& bus) {
    for (std::size_t sent = 0; sent < 10'000;) {
      const std::size_t taken = bus.send(group_of(0), 0);
      sent += taken;
      if (taken < 6) return sent;
    }
    ADD_FAILURE() << "the queue never gets full";
    return 0;
  }
  void empty_queue() {
    while (fake_.take()) {
    }
  }

  test::FakeCan fake_;
};

TEST_F(SocketCanTest, FramesArriveInOrderInTheKernelsFormat) {
  SocketCan bus("can0", true, test::FakeCan::system());
  const std::array frames{
      CanFrame{.id = 0x7FF, .length = 2, .data = {std::byte{1}, std::byte{0xFE}}},
      CanFrame{.id = 0x1FFFFFFF, .extended = true, .length = 8, .data = {std::byte{2}}},
      CanFrame{.id = 0x3A9, .fd = true, .bit_rate_switch = true, .length = 64, .data = {std::byte{3}}},
      CanFrame{.id = 0x3A9, .extended = true, .fd = true, .length = 0},
  };
  EXPECT_EQ(bus.send(frames, 0), frames.size());
  expect_arrived(frames);
  const BusStatus status = bus.status();
  EXPECT_EQ(status.state, BusState::up);
  EXPECT_EQ(status.error, 0);
  EXPECT_EQ(status.frames_sent, 4U);
}

TEST_F(SocketCanTest, AFullQueueDropsTheRestOfTheGroupAndTheNextPoseWins) {
  SocketCan bus("can0", false, test::FakeCan::system());
  const std::size_t sent = fill_queue(bus);
  EXPECT_EQ(bus.send(group_of(1), 0), 0U);
  EXPECT_EQ(bus.status().frames_sent, sent);
  EXPECT_EQ(bus.status().dropped_queue_full, 6 - sent % 6 + 6);
  EXPECT_EQ(bus.status().dropped_bus_down, 0U);
  EXPECT_EQ(bus.status().state, BusState::up) << "a full queue is no fault of the bus";

  empty_queue();
  const auto next = group_of(2);
  EXPECT_EQ(bus.send(next, 0), next.size());
  expect_arrived(next);
}

TEST_F(SocketCanTest, AnInterfaceThatIsMissingAtFirstIsFoundWhenItComes) {
  fake_.open_error = ENODEV;
  SocketCan bus("can0", false, test::FakeCan::system());
  EXPECT_EQ(bus.status().state, BusState::missing);
  EXPECT_EQ(bus.status().error, ENODEV);
  EXPECT_EQ(bus.send(group_of(1), 0), 0U);
  EXPECT_EQ(bus.status().dropped_bus_down, 6U);
  bus.maintain(0);
  fake_.open_error = 0;
  bus.maintain(99 * kMs_ns);
  EXPECT_EQ(bus.status().state, BusState::missing) << "tried again before 100 ms";
  bus.maintain(100 * kMs_ns);
  EXPECT_EQ(bus.status().state, BusState::up);
  EXPECT_EQ(bus.status().error, 0);
  EXPECT_EQ(fake_.times_opened, 3);
  EXPECT_EQ(bus.status().times_lost, 0U);
  const auto group = group_of(2);
  EXPECT_EQ(bus.send(group, 0), group.size());
  expect_arrived(group);
}

TEST_F(SocketCanTest, WithoutCanInTheKernelItIsSeldomTried) {
  fake_.open_error = EAFNOSUPPORT;
  SocketCan bus("can0", false, test::FakeCan::system());
  EXPECT_EQ(bus.status().state, BusState::missing);
  for (int i = 0; i < 1000; ++i) bus.maintain(i * 20 * kMs_ns);
  EXPECT_EQ(fake_.times_opened, 1 + 2);
}

TEST_F(SocketCanTest, AnInterfaceThatGoesAndComesBackIsOpenedAnew) {
  SocketCan bus("can0", false, test::FakeCan::system());
  EXPECT_EQ(bus.send(group_of(1), 0), 6U);
  fake_.remove();
  EXPECT_EQ(bus.send(group_of(2), 0), 0U);
  EXPECT_EQ(bus.status().state, BusState::missing);
  EXPECT_EQ(bus.status().times_lost, 1U);
  EXPECT_EQ(bus.status().dropped_bus_down, 6U);
  bus.maintain(0);
  fake_.open_error = 0;
  bus.maintain(100 * kMs_ns);
  EXPECT_EQ(bus.status().state, BusState::up);
  const auto group = group_of(3);
  EXPECT_EQ(bus.send(group, 0), group.size());
  expect_arrived(group);
  EXPECT_EQ(bus.status().times_lost, 1U);
}

TEST_F(SocketCanTest, ALinkThatGoesDownAndUpIsFollowed) {
  SocketCan bus("can0", false, test::FakeCan::system());
  bus.maintain(0);
  fake_.link.is_up = false;
  bus.maintain(100 * kMs_ns);
  EXPECT_EQ(bus.status().state, BusState::down);
  EXPECT_EQ(bus.status().error, ENETDOWN);
  fake_.link.is_up = true;
  bus.maintain(200 * kMs_ns);
  EXPECT_EQ(bus.status().state, BusState::up);
  EXPECT_EQ(bus.status().times_lost, 0U);
  EXPECT_EQ(fake_.times_opened, 1);
}

TEST_F(SocketCanTest, AFrameThatGoesThroughShowsThatTheLinkIsUpAgain) {
  fake_.link.is_up = false;
  SocketCan bus("can0", false, test::FakeCan::system());
  EXPECT_EQ(bus.status().state, BusState::down);
  EXPECT_EQ(bus.send(group_of(1), 0), 6U);
  EXPECT_EQ(bus.status().state, BusState::up);
}

TEST_F(SocketCanTest, ErrorPassiveIsToldAndSendsOn) {
  SocketCan bus("can0", false, test::FakeCan::system());
  fake_.report_error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
  bus.maintain(0);
  EXPECT_EQ(bus.status().state, BusState::error_passive);
  EXPECT_EQ(bus.send(group_of(1), 0), 6U);
  EXPECT_EQ(bus.status().state, BusState::error_passive);
  fake_.report_error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW);
  bus.maintain(1);
  EXPECT_EQ(bus.status().state, BusState::error_passive) << "an overflow says nothing of the error counters";
  fake_.report_error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING);
  bus.maintain(2);
  EXPECT_EQ(bus.status().state, BusState::up);
}

TEST_F(SocketCanTest, NothingIsSentBetweenBusOffAndRestart) {
  SocketCan bus("can0", false, test::FakeCan::system());
  fake_.report_error(CAN_ERR_BUSOFF);
  bus.maintain(0);
  EXPECT_EQ(bus.status().state, BusState::bus_off);
  EXPECT_EQ(bus.send(group_of(1), 0), 0U);
  EXPECT_EQ(bus.status().dropped_bus_down, 6U);
  expect_arrived({});
  // The kernel's view of the link lags behind.
  bus.maintain(500 * kMs_ns);
  EXPECT_EQ(bus.status().state, BusState::bus_off);
  fake_.report_error(CAN_ERR_RESTARTED);
  bus.maintain(501 * kMs_ns);
  EXPECT_EQ(bus.status().state, BusState::up);
  const auto group = group_of(2);
  EXPECT_EQ(bus.send(group, 0), group.size());
  expect_arrived(group);
}

TEST_F(SocketCanTest, ARestartThatNobodyToldOfIsSeenByTheLink) {
  SocketCan bus("can0", false, test::FakeCan::system());
  fake_.link.is_running = false;
  bus.maintain(0);
  EXPECT_EQ(bus.status().state, BusState::bus_off);
  fake_.report_error(CAN_ERR_BUSOFF);
  bus.maintain(100 * kMs_ns);
  fake_.link.is_running = true;
  bus.maintain(2000 * kMs_ns);
  EXPECT_EQ(bus.status().state, BusState::bus_off);
  bus.maintain(2100 * kMs_ns);
  EXPECT_EQ(bus.status().state, BusState::up);
}

TEST_F(SocketCanTest, NothingOfItTouchesTheHeap) {
  if (!HeapCounter::available()) GTEST_SKIP() << "the heap is not counted here";
  SocketCan bus("can0", true, test::FakeCan::system());
  fake_.report_error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
  const auto group = group_of(1);
  const std::uint64_t before = HeapCounter::calls();
  HeapCounter::arm();
  for (int i = 0; i < 100; ++i) {
    bus.maintain(i * 50 * kMs_ns);
    (void)bus.send(group, 0);
    if (i == 50) fake_.remove();
    if (i == 60) fake_.open_error = 0;
  }
  HeapCounter::disarm();
  EXPECT_EQ(HeapCounter::calls(), before);
  EXPECT_EQ(bus.status().times_lost, 1U);
  EXPECT_EQ(bus.status().state, BusState::up);
  EXPECT_GT(bus.status().dropped_queue_full, 0U);
  EXPECT_GT(bus.status().dropped_bus_down, 0U);
}

TEST(LinuxCan, AMissingInterfaceIsAStateAndNoError) {
  SocketCan bus("no-such-can", true);
  EXPECT_EQ(bus.status().state, BusState::missing);
  EXPECT_TRUE(bus.status().error == ENODEV || bus.status().error == EAFNOSUPPORT) << bus.status().error;
  bus.maintain(0);
  EXPECT_EQ(bus.send(group_of(1), 0), 0U);
}

}  // namespace
}  // namespace landfix::platform
