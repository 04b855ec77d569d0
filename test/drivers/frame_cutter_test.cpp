// Frames by their ids: what belongs together, what is missing, late, double or of another start.
#include "drivers/ouster/frame_cutter.hpp"

#include <gtest/gtest.h>

#include "support/decoder_bench.hpp"
#include "support/ouster_packets.hpp"

namespace landfix::drivers {
namespace {

using ouster::Metadata;
using ouster::Profile;

constexpr std::int64_t kTurnNs = 100'000'000;
constexpr std::int64_t kPacketNs = kTurnNs / 64;

/// A sensor with 64 packets a turn; every packet holds one return for each of its columns.
class FrameCutter : public testing::Test {
 protected:
  explicit FrameCutter(const Metadata& metadata = test::ouster_metadata(Profile::low_rate))
      : metadata_(metadata), bench_("os1-64", {}, 10'000, metadata) {}

  /// Of frame `turn` since the start, whose id may be another.
  DecodeResult send(int turn, std::size_t number, std::uint32_t frame_id) {
    test::OusterPacket packet(metadata_);
    const std::int64_t first_ns = clock_ns_ + turn * kTurnNs + static_cast<std::int64_t>(number) * kPacketNs;
    packet.set_place(number, first_ns);
    packet.set_frame(frame_id);
    packet.set_init_id(init_id_);
    for (std::size_t column = 0; column < 16; ++column) packet.set_return(column, 0, 1000);
    return bench_.decode(packet.bytes(), receive_ns_ + first_ns + 2'000'000);
  }
  DecodeResult send(int turn, std::size_t number) {
    return send(turn, number, static_cast<std::uint32_t>(100 + turn));
  }
  void send_turn_as(int turn, std::uint32_t frame_id, std::size_t first = 0, std::size_t end = 64) {
    for (std::size_t number = first; number < end; ++number) {
      ASSERT_EQ(send(turn, number, frame_id).status, DecodeStatus::decoded) << turn << ":" << number;
    }
  }
  void send_turn(int turn, std::size_t first = 0, std::size_t end = 64) {
    send_turn_as(turn, static_cast<std::uint32_t>(100 + turn), first, end);
  }

  void expect_complete(const std::vector<bool>& complete) const {
    std::vector<bool> is;
    for (const auto& sweep : bench_.swept()) is.push_back(sweep.complete);
    EXPECT_EQ(is, complete);
  }
  /// Times are those of the columns, from the first on.
  void expect_times() const {
    for (const auto& sweep : bench_.swept()) {
      float least = 1.0F;
      for (const Point& point : sweep.points) least = std::min(least, point.time_s);
      EXPECT_EQ(least, 0.0F);
    }
  }
  const StreamCounters& counters() { return bench_.counters(); }

  Metadata metadata_;
  test::DecoderBench bench_;
  std::int64_t clock_ns_ = test::kReceiveUtcNs;
  std::int64_t receive_ns_ = 0;  ///< the receiver's clock - the sensor's
  std::uint32_t init_id_ = 7;
};

TEST_F(FrameCutter, HandsAFrameOverWithItsLastPacket) {
  send_turn(0, 0, 63);
  EXPECT_TRUE(bench_.swept().empty());
  EXPECT_TRUE(send(0, 63).sweep_completed);
  expect_complete({true});
  EXPECT_EQ(bench_.swept()[0].points.size(), 1024U);
  EXPECT_TRUE(bench_.points().empty()) << "nothing of an older sweep shows";
  send_turn(1);
  expect_complete({true, true});
  EXPECT_EQ(bench_.swept()[1].start_utc_ns, clock_ns_ + kTurnNs);
  EXPECT_FALSE(bench_.flush());
  EXPECT_EQ(counters().lost_packets, 0U);
}

TEST_F(FrameCutter, OrderWithinAFrameDoesNotMatter) {
  for (std::size_t i = 0; i < 64; ++i) {
    // Pairs swapped, the first of all too; and one that is overtaken by ten.
    const std::size_t number = i == 40 ? 50 : i > 40 && i <= 50 ? i - 1 : i < 40 ? i ^ 1U : i;
    ASSERT_EQ(send(0, number).status, DecodeStatus::decoded);
  }
  expect_complete({true});
  expect_times();
  EXPECT_EQ(bench_.swept()[0].start_utc_ns, clock_ns_);
  EXPECT_NEAR(bench_.swept()[0].points[16].time_s, 0.0, 1e-7) << "the first packet came second";
  EXPECT_NEAR(bench_.swept()[0].points[0].time_s, 1e-9 * kPacketNs, 1e-7);
  EXPECT_EQ(counters().lost_packets, 0U);
}

TEST_F(FrameCutter, AFrameWithALossIsHandedOverByTheNext) {
  send_turn(0);
  send_turn(1, 0, 20);
  send_turn(1, 23);
  expect_complete({true});
  EXPECT_TRUE(send(2, 0).sweep_completed);
  expect_complete({true, false});
  EXPECT_EQ(counters().lost_packets, 3U);
  EXPECT_EQ(bench_.swept()[1].points.size(), 61U * 16U);
  EXPECT_EQ(send(1, 21).status, DecodeStatus::late);
  send_turn(2, 1);
  expect_complete({true, false, true});
  EXPECT_EQ(counters().lost_packets, 3U);
}

TEST_F(FrameCutter, LostFramesAreCountedByTheirIds) {
  send_turn(0);
  send_turn(5);
  expect_complete({true, true});
  EXPECT_EQ(counters().lost_packets, 4U * 64U);
  EXPECT_EQ(counters().restarts, 0U);
}

TEST_F(FrameCutter, DuplicatesAreRefused) {
  send_turn(0, 0, 10);
  EXPECT_EQ(send(0, 9).status, DecodeStatus::duplicate);
  EXPECT_EQ(send(0, 0).status, DecodeStatus::duplicate);
  send_turn(0, 10);
  expect_complete({true});
  EXPECT_EQ(bench_.swept()[0].points.size(), 1024U);
  EXPECT_EQ(send(0, 63).status, DecodeStatus::duplicate) << "of a frame that has been handed over";
  send_turn(1);
  EXPECT_EQ(send(0, 63).status, DecodeStatus::late);
  expect_complete({true, true});
}

TEST_F(FrameCutter, WhatWasSentBeforeTheStreamBeganIsNotLost) {
  send_turn(0, 40);
  send_turn(1, 0, 30);
  expect_complete({false});
  EXPECT_TRUE(bench_.flush());
  expect_complete({false, false});
  EXPECT_EQ(counters().lost_packets, 0U);
  expect_times();
}

TEST_F(FrameCutter, FlushCountsTheGapsThatThereAre) {
  send_turn(0, 0, 10);
  send_turn(0, 12, 20);
  EXPECT_TRUE(bench_.flush());
  EXPECT_EQ(counters().lost_packets, 2U);
  send_turn(0, 20);
  send_turn(1, 0, 1);
  expect_complete({false, false});
  EXPECT_EQ(counters().lost_packets, 2U);
}

TEST_F(FrameCutter, IdsWrap) {
  send_turn_as(0, 65'534);
  send_turn_as(1, 65'535);
  send_turn_as(2, 0);
  EXPECT_EQ(send(1, 3, 65'535).status, DecodeStatus::late);
  send_turn_as(3, 1);
  expect_complete({true, true, true, true});
  EXPECT_EQ(counters().lost_packets, 0U);
  EXPECT_EQ(counters().restarts, 0U);
}

TEST_F(FrameCutter, AnotherInitIdIsARestart) {
  send_turn_as(0, 5000);
  send_turn_as(1, 5001, 0, 30);
  init_id_ = 8;
  send_turn_as(2, 0, 10);
  expect_complete({true, false});
  send_turn_as(3, 1);
  expect_complete({true, false, false, true});
  EXPECT_EQ(counters().restarts, 1U);
  EXPECT_EQ(counters().lost_packets, 0U) << "what is missing was never sent";
}

TEST_F(FrameCutter, AnOlderIdWithANewerTimeIsARestart) {
  init_id_ = 0;  // as LEGACY packets have none
  send_turn_as(0, 40'000);
  send_turn_as(300, 0);
  send_turn_as(301, 1);
  expect_complete({true, true, true});
  EXPECT_EQ(counters().restarts, 1U);
  EXPECT_EQ(counters().lost_packets, 0U);
  // 25536 ids ahead, modulo 65536, cannot be after 300 turns either.
  send_turn_as(302, 3000);
  EXPECT_EQ(counters().restarts, 2U);
}

TEST_F(FrameCutter, APowerCycleSetsTheClockBackToo) {
  init_id_ = 0;
  clock_ns_ = 500'000'000'000;  // counts from power-up
  receive_ns_ = test::kReceiveUtcNs - clock_ns_;
  send_turn_as(0, 40'000);
  clock_ns_ = 3'000'000'000;
  receive_ns_ += 500'000'000'000 - 3'000'000'000 + 30'000'000'000;
  EXPECT_EQ(send(0, 0, 0).status, DecodeStatus::wrong_time) << "one packet is no witness";
  EXPECT_EQ(send(0, 1, 0).status, DecodeStatus::decoded);
  for (std::size_t number = 2; number < 64; ++number)
    EXPECT_EQ(send(0, number, 0).status, DecodeStatus::decoded);
  send_turn_as(1, 1);
  expect_complete({true, false, true});
  EXPECT_EQ(counters().restarts, 1U);
  EXPECT_EQ(counters().clock_steps, 0U);
  EXPECT_EQ(bench_.swept()[2].time_source, TimeSource::receive);
}

TEST_F(FrameCutter, AClockThatIsSetTearsTheFrame) {
  send_turn(0);
  send_turn(1, 0, 30);
  clock_ns_ += 5'000'000'000;
  receive_ns_ -= 5'000'000'000;
  EXPECT_EQ(send(1, 30).status, DecodeStatus::wrong_time);
  send_turn(1, 31);
  send_turn(2);
  expect_complete({true, false, false, true});
  expect_times();
  EXPECT_EQ(counters().clock_steps, 1U);
  EXPECT_EQ(counters().restarts, 0U);
  EXPECT_EQ(counters().lost_packets, 1U) << "the witness";
}

TEST_F(FrameCutter, AStreamThatIsSetBackIsTakenUpAfterAFrameOfRefusals) {
  for (int turn = 0; turn < 4; ++turn) send_turn(turn);
  int refused = 0;
  for (int turn = 1; turn < 6; ++turn) {  // as a recording does that is played again
    for (std::size_t number = 0; number < 64; ++number) {
      refused += is_rejected(send(turn, number).status) ? 1 : 0;
    }
  }
  EXPECT_LE(refused, 66);
  EXPECT_EQ(counters().restarts, 1U);
  EXPECT_TRUE(bench_.swept().back().complete);
}

TEST_F(FrameCutter, FirmwareWithoutFrameIdsIsCutByTime) {
  send_turn_as(0, 0, 30);
  send_turn_as(1, 0);
  send_turn_as(2, 0);
  send_turn_as(3, 0, 1, 64);  // the first is lost
  send_turn_as(4, 0, 0, 1);
  expect_complete({false, true, true, false});
  EXPECT_EQ(counters().lost_packets, 1U);
  EXPECT_EQ(counters().restarts, 0U);
}

TEST_F(FrameCutter, APacketWithoutAnythingTakesItsPlaceAllTheSame) {
  test::OusterPacket nothing(metadata_);
  nothing.set_place(0, 0);
  nothing.set_frame(100);
  for (std::size_t column = 0; column < 16; ++column) nothing.set_valid(column, false);
  EXPECT_EQ(bench_.decode(nothing.bytes()).status, DecodeStatus::decoded);
  EXPECT_EQ(bench_.decode(nothing.bytes()).status, DecodeStatus::duplicate);
  init_id_ = 0;
  send_turn(0, 1);
  expect_complete({true});
  EXPECT_EQ(bench_.swept()[0].start_utc_ns, clock_ns_ + kPacketNs);
}

Metadata with_window(std::size_t first, std::size_t last, std::size_t columns) {
  Metadata metadata = test::ouster_metadata(Profile::low_rate, 64, columns);
  metadata.window = {.first = first, .last = last};
  return metadata;
}

TEST(FrameCutterWindow, HoldsThePacketsThatCoverIt) {
  // Counts of two recordings with windows, of 32 packets a turn.
  const auto count = [](const Metadata& metadata) {
    const ouster::FrameCutter cutter(metadata);
    int packets = 0;
    for (std::size_t number = 0; number < 5000; ++number) packets += cutter.expects(number) ? 1 : 0;
    return packets;
  };
  EXPECT_EQ(count(with_window(1, 256, 512)), 17);
  EXPECT_EQ(count(with_window(370, 85, 512)), 15);
  EXPECT_EQ(count(with_window(100, 99, 512)), 32) << "all of it";
  EXPECT_EQ(count(with_window(0, 511, 512)), 32);
  EXPECT_EQ(count(with_window(0, 4095, 4096)), 256);
}

class WindowedFrame : public FrameCutter {
 protected:
  WindowedFrame() : FrameCutter(with_window(970, 85, 1024)) {}
};

TEST_F(WindowedFrame, IsCompleteWithoutTheRest) {
  for (int turn = 0; turn < 3; ++turn) {
    send_turn(turn, 0, 6);
    EXPECT_EQ(bench_.swept().size(), static_cast<std::size_t>(turn));
    send_turn(turn, 60, 64);
    EXPECT_EQ(bench_.swept().size(), static_cast<std::size_t>(turn) + 1);
  }
  expect_complete({true, true, true});
  EXPECT_EQ(bench_.swept()[1].points.size(), 86U + 54U);
  EXPECT_EQ(counters().lost_packets, 0U);
}

class OnePacketFrame : public FrameCutter {
 protected:
  OnePacketFrame() : FrameCutter(with_window(513, 520, 1024)) {}
};

TEST_F(OnePacketFrame, IsHandedOverOneByOne) {
  for (int turn = 0; turn < 5; ++turn) EXPECT_EQ(send(turn, 32).status, DecodeStatus::decoded);
  static_cast<void>(bench_.flush());
  expect_complete({true, true, true, true, true});
  EXPECT_EQ(counters().lost_packets, 0U);
}

class FusaFrame : public FrameCutter {
 protected:
  FusaFrame() : FrameCutter(test::ouster_metadata(Profile::low_rate_dual_fusa)) {}
};

TEST_F(FusaFrame, IdsHave32Bits) {
  send_turn_as(0, 65'535);
  send_turn_as(1, 65'536);
  EXPECT_EQ(send(0, 3, 65'535).status, DecodeStatus::late);
  expect_complete({true, true});
  init_id_ = 9;
  send_turn_as(2, 0xFFFF'FFFF);
  send_turn_as(3, 0);
  EXPECT_EQ(send(2, 3, 0xFFFF'FFFF).status, DecodeStatus::late);
  expect_complete({true, true, true, true});
  EXPECT_EQ(counters().restarts, 1U);
}

}  // namespace
}  // namespace landfix::drivers
