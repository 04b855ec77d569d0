#include "drivers/sweep_builder.hpp"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace landfix::drivers {
namespace {

constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;
constexpr std::int64_t kTurnNs = 100'000'000;
constexpr std::int64_t kBlockNs = kTurnNs / 360;
constexpr int kBlocksAPacket = 4;

/// A sensor with a block a degree and four blocks a packet, one point a block.
class OneDegreeSensor {
 public:
  explicit OneDegreeSensor(bool counts_packets = false) : counts_packets_(counts_packets) {}

  void turn(int degrees) {
    for (int i = 0; i < degrees; i += kBlocksAPacket) {
      send();
      lose(kBlocksAPacket);
    }
  }
  /// The rotor turns on and nothing arrives.
  void skip(int degrees) {
    degree_ += degrees;
    time_ns_ += degrees * kBlockNs;
    receive_ns_ += degrees * kBlockNs;
  }
  void lose(int degrees) {
    skip(degrees);
    sequence_ += static_cast<std::uint32_t>(degrees / kBlocksAPacket);
  }
  void set_clock(std::int64_t by_ns) { time_ns_ += by_ns; }

  SweepBuilder builder{0.0};
  std::vector<Point> storage = std::vector<Point>(2000);
  SweepPair sweeps{storage};
  std::vector<std::size_t> sizes;  ///< of the sweeps that were handed over
  std::vector<bool> complete;
  std::vector<DecodeStatus> refused;

  /// A packet from `packets_ago` packets ago, once more or for the first time.
  void send_late(int packets_ago) {
    lose(-packets_ago * kBlocksAPacket);
    send();
    lose(packets_ago * kBlocksAPacket);
  }
  [[nodiscard]] std::int64_t time_ns() const { return time_ns_; }
  [[nodiscard]] std::int64_t receive_ns() const { return receive_ns_; }
  void restart_counting() { sequence_ = 0; }

 private:
  void send() {
    std::optional<std::uint32_t> sequence;
    if (counts_packets_) sequence = sequence_;
    const DecodeStatus place = builder.begin_packet({.first_firing_ns = time_ns_,
                                                     .receive_utc_ns = receive_ns_,
                                                     .duration_ns = kBlocksAPacket * kBlockNs,
                                                     .turn_ns = kTurnNs,
                                                     .sequence = sequence},
                                                    azimuth(0), sweeps);
    if (place != DecodeStatus::decoded) {
      refused.push_back(place);
      return;
    }
    for (int block = 0; block < kBlocksAPacket; ++block) {
      const float time_s = builder.begin_block(azimuth(block), time_ns_ + block * kBlockNs, sweeps);
      EXPECT_GE(time_s, 0.0F);
      EXPECT_LE(time_s, 0.16F);
      sweeps.current().push({.time_s = time_s});
    }
    if (!builder.has_cut()) return;
    sizes.push_back(sweeps.completed().points().size());
    complete.push_back(sweeps.completed().complete());
  }
  [[nodiscard]] std::uint16_t azimuth(int block) const {
    return static_cast<std::uint16_t>((degree_ + block) % 360 * 100);
  }

  bool counts_packets_;
  int degree_ = 2;
  std::int64_t time_ns_ = kStartNs;  ///< of the sensor
  std::int64_t receive_ns_ = kStartNs + 1'000'000;
  std::uint32_t sequence_ = 0;
};

using Complete = std::vector<bool>;
using Sizes = std::vector<std::size_t>;

TEST(SweepBuilder, TheFirstTurnIsPartialAndTheNextOnesComplete) {
  OneDegreeSensor sensor;
  sensor.turn(3 * 360);
  EXPECT_EQ(sensor.complete, (Complete{false, true, true}));
  EXPECT_EQ(sensor.sizes, (Sizes{358, 360, 360}));
}

TEST(SweepBuilder, HandsOverTheRestAsPartialOnce) {
  OneDegreeSensor sensor;
  EXPECT_FALSE(sensor.builder.flush(sensor.sweeps)) << "nothing yet";
  sensor.turn(400);
  ASSERT_TRUE(sensor.builder.flush(sensor.sweeps));
  EXPECT_FALSE(sensor.sweeps.completed().complete());
  EXPECT_EQ(sensor.sweeps.completed().points().size(), 42U);
  EXPECT_FALSE(sensor.builder.flush(sensor.sweeps));
}

TEST(SweepBuilder, ALostPacketMakesItsTurnPartialAndNoOther) {
  OneDegreeSensor sensor;
  sensor.turn(500);
  sensor.lose(4);
  sensor.turn(3 * 360);
  EXPECT_EQ(sensor.complete, (Complete{false, false, true, true}));
}

TEST(SweepBuilder, PacketsLostAcrossTheCutMakeBothTurnsPartial) {
  for (const bool counts_packets : {false, true}) {
    OneDegreeSensor sensor(counts_packets);
    sensor.turn(360 + 340);
    sensor.lose(40);
    sensor.turn(2 * 360);
    EXPECT_EQ(sensor.complete, (Complete{false, false, false, true})) << counts_packets;
  }
}

TEST(SweepBuilder, ASectorThatIsDarkInEveryTurnIsNoLoss) {
  OneDegreeSensor sensor;
  for (int turn = 0; turn < 5; ++turn) {
    sensor.turn(180);
    sensor.skip(180);
  }
  // The first turn of all is partial, and the second, for its gap was the first of its kind.
  ASSERT_EQ(sensor.complete.size(), 4U);
  EXPECT_TRUE(sensor.complete[2]);
  EXPECT_TRUE(sensor.complete[3]);
  EXPECT_EQ(sensor.sizes[3], 180U);
}

TEST(SweepBuilder, CountsLossesThatComeAgainAndAgain) {
  for (const int every : {2, 3, 5, 50}) {
    OneDegreeSensor sensor;
    sensor.turn(360);
    std::uint64_t lost = 0;
    for (int packet = 0; packet < 4 * 90; ++packet) {
      if (packet % every == 0 && packet + 1 < 4 * 90) {
        sensor.lose(kBlocksAPacket);
        ++lost;
      } else {
        sensor.turn(kBlocksAPacket);
      }
    }
    EXPECT_EQ(sensor.builder.counters().lost_packets, lost) << every;
    for (std::size_t i = 1; i < sensor.complete.size(); ++i) EXPECT_FALSE(sensor.complete[i]) << every;
  }
}

TEST(SweepBuilder, CutsATurnThatLastsTooLong) {
  OneDegreeSensor sensor;
  sensor.turn(360 + 20);
  sensor.skip(3600);  // a second without packets, to the same azimuth
  sensor.turn(4);
  EXPECT_EQ(sensor.complete, (Complete{false, false}));
  EXPECT_EQ(sensor.sizes[1], 22U);
}

TEST(SweepBuilder, HandsOverOneSweepAPacketAndForgetsTheBlocksBetweenTwoCuts) {
  OneDegreeSensor sensor;
  sensor.turn(360);
  sensor.skip(3600 - 4);
  sensor.turn(4);  // 358 to 1 deg: cut by time before it, by azimuth within it
  EXPECT_EQ(sensor.complete, (Complete{false, false}));
  EXPECT_EQ(sensor.sweeps.current().points().size(), 2U);
}

TEST(SweepBuilder, CutsWhenTheSensorsClockIsSet) {
  OneDegreeSensor sensor;
  sensor.turn(360 + 100);
  sensor.set_clock(-kTurnNs / 4);
  sensor.turn(360);
  EXPECT_EQ(sensor.refused, std::vector{DecodeStatus::wrong_time}) << "the first packet alone is no proof";
  EXPECT_EQ(sensor.complete, (Complete{false, false, false}));
  EXPECT_EQ(sensor.sizes[1], 102U);
  EXPECT_EQ(sensor.builder.counters().clock_steps, 1U);
  sensor.turn(360);
  EXPECT_EQ(sensor.complete.back(), true);
}

TEST(SweepBuilder, DropsOnePacketOfAnotherTimeAndKeepsTheSweep) {
  OneDegreeSensor sensor;
  sensor.turn(360 + 100);
  sensor.set_clock(1'800'000'000'000);
  sensor.turn(4);
  sensor.set_clock(-1'800'000'000'000);
  sensor.turn(2 * 360);
  EXPECT_EQ(sensor.refused, std::vector{DecodeStatus::wrong_time});
  EXPECT_EQ(sensor.complete, (Complete{false, false, true}));
  EXPECT_EQ(sensor.sizes, (Sizes{358, 356, 360}));
  EXPECT_EQ(sensor.builder.counters().clock_steps, 0U);
  EXPECT_EQ(sensor.builder.counters().lost_packets, 1U);
}

TEST(SweepBuilder, CountsThePacketsThatAreLost) {
  for (const bool counts_packets : {false, true}) {
    OneDegreeSensor sensor(counts_packets);
    sensor.turn(500);
    sensor.lose(12);
    sensor.turn(360);
    EXPECT_EQ(sensor.builder.counters().lost_packets, 3U) << counts_packets;
    EXPECT_EQ(sensor.sweeps.completed().lost_packets(), 3U) << counts_packets;
    EXPECT_FALSE(sensor.sweeps.completed().complete()) << counts_packets;
  }
}

TEST(SweepBuilder, DropsAPacketThatComesTwice) {
  for (const bool counts_packets : {false, true}) {
    OneDegreeSensor sensor(counts_packets);
    sensor.turn(360);  // to within two degrees of the cut, and a packet over it
    sensor.send_late(1);
    sensor.send_late(5);
    sensor.turn(2 * 360);
    EXPECT_EQ(sensor.refused, (std::vector{DecodeStatus::duplicate, DecodeStatus::duplicate}));
    EXPECT_EQ(sensor.sizes, (Sizes{358, 360, 360}));
    EXPECT_EQ(sensor.complete, (Complete{false, true, true}));
    EXPECT_EQ(sensor.builder.counters().lost_packets, 0U);
    EXPECT_EQ(sensor.builder.counters().restarts, 0U);
  }
}

TEST(SweepBuilder, APacketThatIsOvertakenJoinsItsSweep) {
  for (const bool counts_packets : {false, true}) {
    OneDegreeSensor sensor(counts_packets);
    sensor.turn(500);
    sensor.lose(4);
    sensor.turn(8);
    EXPECT_EQ(sensor.builder.counters().lost_packets, 1U);
    sensor.send_late(3);
    EXPECT_EQ(sensor.builder.counters().lost_packets, 0U);
    sensor.turn(2 * 360);
    EXPECT_TRUE(sensor.refused.empty());
    EXPECT_EQ(sensor.sizes, (Sizes{358, 360, 360}));
    EXPECT_EQ(sensor.complete, (Complete{false, true, true}));
  }
}

TEST(SweepBuilder, APacketThatIsOvertakenAtTheCutIsTooLate) {
  for (const bool counts_packets : {false, true}) {
    OneDegreeSensor sensor(counts_packets);
    sensor.turn(720 - 4);
    sensor.lose(4);  // 358 to 1 deg
    sensor.turn(4);
    sensor.send_late(2);
    sensor.turn(2 * 360);
    EXPECT_EQ(sensor.refused, std::vector{DecodeStatus::late});
    EXPECT_EQ(sensor.complete, (Complete{false, false, false, true})) << "both turns miss a part of it";
    EXPECT_EQ(sensor.builder.counters().lost_packets, 1U);
  }
}

TEST(SweepBuilder, NoticesThatASensorHasStartedAnew) {
  OneDegreeSensor sensor(true);
  sensor.turn(500);
  sensor.restart_counting();
  sensor.turn(2 * 360);
  EXPECT_EQ(sensor.builder.counters().restarts, 1U);
  EXPECT_EQ(sensor.builder.counters().lost_packets, 0U);
  EXPECT_EQ(sensor.complete, (Complete{false, false, false, true}));
}

TEST(SweepBuilder, CutsWhenTheSensorSaysThatUtcIsAnother) {
  OneDegreeSensor sensor;
  sensor.turn(500);
  const std::int64_t hour_ns = 3'600'000'000'000;
  sensor.builder.learn_utc(sensor.time_ns() + hour_ns, sensor.receive_ns());
  sensor.set_clock(hour_ns);
  sensor.turn(2 * 360);
  EXPECT_TRUE(sensor.refused.empty()) << "it was announced";
  EXPECT_EQ(sensor.complete, (Complete{false, false, false, true}));
  EXPECT_EQ(sensor.sweeps.completed().time_source(), TimeSource::sensor);
}

}  // namespace
}  // namespace landfix::drivers
