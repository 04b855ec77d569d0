#include "platform/can_receiver.hpp"

#include <array>
#include <cerrno>
#include <chrono>

#include <gtest/gtest.h>

#include "platform/heap_counter.hpp"
#include "support/fake_can.hpp"

namespace landfix::platform {
namespace {

class CanReceiverTest : public testing::Test {
 protected:
  test::FakeCan fake_;
  CanFrame frame_;
  std::int64_t stamp_utc_ns_ = 0;
};

std::int64_t now_utc_ns() {
  using namespace std::chrono;
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

TEST_F(CanReceiverTest, FramesComeInOrderWithTheirTime) {
  CanReceiver receiver("can0", {}, test::FakeCan::system());
  EXPECT_FALSE(receiver.receive(frame_, stamp_utc_ns_));
  const std::array frames{
      CanFrame{.id = 0x123, .length = 3, .data = {std::byte{1}}},
      CanFrame{.id = 0x12345, .extended = true, .length = 8, .data = {std::byte{2}}},
      CanFrame{.id = 0x3A9, .fd = true, .bit_rate_switch = true, .length = 64, .data = {std::byte{3}}},
  };
  const std::int64_t began_utc_ns = now_utc_ns();
  for (const CanFrame& frame : frames) fake_.give(frame);
  for (const CanFrame& frame : frames) {
    ASSERT_TRUE(receiver.receive(frame_, stamp_utc_ns_));
    EXPECT_EQ(frame_, frame);
    EXPECT_GE(stamp_utc_ns_, began_utc_ns);
    EXPECT_LE(stamp_utc_ns_, now_utc_ns());
  }
  EXPECT_FALSE(receiver.receive(frame_, stamp_utc_ns_));
  EXPECT_EQ(receiver.frames_received(), 3U);
  EXPECT_EQ(receiver.state(), BusState::up);
}

TEST_F(CanReceiverTest, RemoteAndErrorFramesAndWhatIsNoFrameArePassedOver) {
  CanReceiver receiver("can0", {}, test::FakeCan::system());
  const auto give_with = [&](canid_t flags, std::uint8_t length) {
    WireFrame wire = to_wire({.id = 0x123, .length = 8});
    wire.frame.can_id |= flags;
    wire.frame.len = length;
    fake_.give(wire.bytes());
  };
  give_with(CAN_RTR_FLAG, 8);
  give_with(CAN_ERR_FLAG, 8);
  give_with(0, 9);
  fake_.give(std::array<std::byte, 5>{});
  give_with(0, 8);
  ASSERT_TRUE(receiver.receive(frame_, stamp_utc_ns_));
  EXPECT_EQ(frame_, (CanFrame{.id = 0x123, .length = 8}));
  EXPECT_EQ(receiver.frames_received(), 1U);
}

TEST_F(CanReceiverTest, TheKernelIsAskedForTheWantedIdentifiers) {
  const std::array ids{CanId{0x123}, CanId{0x12345, true}};
  const CanReceiver receiver("can0", ids, test::FakeCan::system());
  ASSERT_EQ(fake_.ids.size(), 2U);
  EXPECT_EQ(fake_.ids[1].id, 0x12345U);
  EXPECT_TRUE(fake_.ids[1].extended);
}

TEST_F(CanReceiverTest, AnInterfaceThatGoesAndComesBackIsOpenedAnewWithItsFilters) {
  const std::array ids{CanId{0x123}};
  CanReceiver receiver("can0", ids, test::FakeCan::system());
  receiver.maintain(0);
  fake_.remove();
  fake_.link = {.error = ENODEV};
  EXPECT_FALSE(receiver.receive(frame_, stamp_utc_ns_));
  receiver.maintain(100'000'000);
  EXPECT_EQ(receiver.state(), BusState::missing);
  EXPECT_LT(receiver.descriptor(), 0);
  EXPECT_FALSE(receiver.receive(frame_, stamp_utc_ns_));
  fake_.open_error = 0;
  fake_.link = {.is_up = true, .is_running = true};
  fake_.ids.clear();
  receiver.maintain(200'000'000);
  EXPECT_EQ(receiver.state(), BusState::up);
  EXPECT_GE(receiver.descriptor(), 0);
  EXPECT_EQ(fake_.ids.size(), 1U);
  fake_.give({.id = 0x123, .length = 1});
  EXPECT_TRUE(receiver.receive(frame_, stamp_utc_ns_));
  EXPECT_EQ(receiver.times_lost(), 1U);
}

TEST_F(CanReceiverTest, ReceivingDoesNotTouchTheHeap) {
  if (!HeapCounter::available()) GTEST_SKIP() << "the heap is not counted here";
  CanReceiver receiver("can0", {}, test::FakeCan::system());
  fake_.give({.id = 0x123, .length = 1});
  const std::uint64_t before = HeapCounter::calls();
  HeapCounter::arm();
  const bool is_received = receiver.receive(frame_, stamp_utc_ns_);
  receiver.maintain(0);
  fake_.remove();
  fake_.link = {.error = ENODEV};
  for (int i = 1; i < 10; ++i) receiver.maintain(i * 100'000'000LL);
  HeapCounter::disarm();
  EXPECT_EQ(HeapCounter::calls(), before);
  EXPECT_TRUE(is_received);
  EXPECT_EQ(receiver.state(), BusState::missing);
}

}  // namespace
}  // namespace landfix::platform
