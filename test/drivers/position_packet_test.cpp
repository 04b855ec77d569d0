#include "drivers/velodyne/position_packet.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/velodyne/block_decoder.hpp"
#include "support/decoder_bench.hpp"
#include "support/synthetic_packets.hpp"

namespace landfix::drivers::velodyne {
namespace {

/// 2015-07-23 21:41:06 UTC.
constexpr std::int64_t kSentenceUtcNs = 1'437'687'666'000'000'000;
/// As a unit on a moving car sent it.
const std::string kSentence = "GPRMC,214106,A,3707.8178,N,12139.2690,W,010.3,188.2,230715,013.8,E,D";

std::string with_checksum(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  std::array<char, 8> tail;
  std::snprintf(tail.data(), tail.size(), "*%02X\r\n", sum);
  return "$" + body + tail.data();
}

std::vector<std::byte> packet_with(const std::string& sentence, std::uint32_t top_of_hour_us = 2'467'110'195,
                                   std::uint8_t pulse = 2) {
  std::vector<std::byte> packet(512);
  std::memcpy(&packet[198], &top_of_hour_us, sizeof(top_of_hour_us));
  packet[202] = std::byte{pulse};
  for (std::size_t i = 0; i < sentence.size(); ++i) packet[206 + i] = static_cast<std::byte>(sentence[i]);
  return packet;
}

TEST(PositionPacket, SaysWhereAndWhenTheSensorIs) {
  const auto packet = parse_position_packet(packet_with(with_checksum(kSentence)));
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->pulse, PulseState::locked);
  ASSERT_TRUE(packet->utc_ns);
  EXPECT_EQ(*packet->utc_ns, kSentenceUtcNs + 1'110'195'000) << "minute and second are the sensor's own";
  ASSERT_TRUE(packet->fix);
  EXPECT_NEAR(packet->fix->latitude_deg, 37.0 + 7.8178 / 60.0, 1e-9);
  EXPECT_NEAR(packet->fix->longitude_deg, -(121.0 + 39.2690 / 60.0), 1e-9);
  EXPECT_NEAR(packet->fix->speed_mps, 10.3 * 0.514444, 1e-5);
  EXPECT_NEAR(packet->fix->course_deg, 188.2, 1e-9);
}

TEST(PositionPacket, CountsOnOverTheHourThatTheReceiverHasNotSeenYet) {
  const auto at = [](const char* time, std::uint32_t top_of_hour_us) {
    std::string body = kSentence;
    body.replace(6, 6, time);
    return *parse_position_packet(packet_with(with_checksum(body), top_of_hour_us))->utc_ns;
  };
  EXPECT_EQ(at("215959", 200'000) - at("215959", 3'599'900'000), 300'000'000);
  EXPECT_EQ(at("220000", 3'599'900'000) - at("215959", 3'599'900'000), 0);
  EXPECT_EQ(at("235959.50", 200'000) - at("215959", 200'000), 2 * 3'600'000'000'000);
}

TEST(PositionPacket, TakesACountSomewhatOverTheHourAsItIs) {
  constexpr std::int64_t kTenPmUtcNs = kSentenceUtcNs + 1'134'000'000'000;
  for (const char* const time : {"215959", "220000"}) {
    std::string body = kSentence;
    body.replace(6, 6, time);
    const auto packet = parse_position_packet(packet_with(with_checksum(body), 3'600'060'000));
    ASSERT_TRUE(packet && packet->utc_ns) << time;
    EXPECT_EQ(*packet->utc_ns, kTenPmUtcNs + 60'000'000) << time;
  }
}

TEST(PositionPacket, CountsOnIntoTheYearThatTheReceiverHasNotSeenYet) {
  std::string body = kSentence;
  body.replace(6, 6, "235959");
  body.replace(body.find("230715"), 6, "311215");
  const auto packet = parse_position_packet(packet_with(with_checksum(body), 200'000));
  ASSERT_TRUE(packet && packet->utc_ns);
  EXPECT_EQ(*packet->utc_ns, 1'451'606'400'200'000'000) << "2016-01-01 00:00:00.2";
}

TEST(PositionPacket, TrustsNoStateOfThePulseThatIsNotDocumented) {
  for (const auto state : std::to_array<std::uint8_t>({4, 77, 255})) {
    const auto packet = parse_position_packet(packet_with(with_checksum(kSentence), 1000, state));
    ASSERT_TRUE(packet);
    EXPECT_EQ(packet->pulse, PulseState::error);
    EXPECT_FALSE(packet->utc_ns);
  }
}

TEST(PositionPacket, FindsNoPlaceOffTheEarthOrInWhatIsNoNumber) {
  const auto fix_at = [](const std::string& latitude, const std::string& longitude) {
    return parse_position_packet(
               packet_with(with_checksum("GPRMC,214106,A," + latitude + ",N," + longitude + ",W,1,1,230715")))
        ->fix;
  };
  ASSERT_TRUE(fix_at("9000.0", "18000.0"));
  EXPECT_FALSE(fix_at("9000.0001", "12139.2690"));
  EXPECT_FALSE(fix_at("3707.8178", "18000.0001"));
  for (const char* const wrong : {"999999999999999", "3760.0", ".", "37.07.8", "-3707.8", "1e3", "inf"}) {
    EXPECT_FALSE(fix_at(wrong, "12139.2690")) << wrong;
    EXPECT_FALSE(fix_at("3707.8178", wrong)) << wrong;
  }
}

TEST(PositionPacket, BelievesNoTimeWithoutALockedPulseAndAValidFix) {
  EXPECT_FALSE(parse_position_packet(packet_with(with_checksum(kSentence), 1000, 1))->utc_ns);
  EXPECT_TRUE(parse_position_packet(packet_with(with_checksum(kSentence), 1000, 1))->fix);
  std::string invalid = kSentence;
  invalid[13] = 'V';
  const auto packet = parse_position_packet(packet_with(with_checksum(invalid)));
  ASSERT_TRUE(packet);
  EXPECT_FALSE(packet->utc_ns);
  EXPECT_FALSE(packet->fix);
}

TEST(PositionPacket, TakesWhatAReceiverMayLeaveEmpty) {
  const auto standing = parse_position_packet(
      packet_with(with_checksum("GNRMC,214106.00,A,3707.8178,S,12139.2690,E,,,230715,,,A")));
  ASSERT_TRUE(standing && standing->fix && standing->utc_ns);
  EXPECT_LT(standing->fix->latitude_deg, 0.0);
  EXPECT_GT(standing->fix->longitude_deg, 0.0);
  EXPECT_EQ(standing->fix->speed_mps, 0.0);
  for (const char* body :
       {"GPRMC,,A,,,,,,,,,", "GPRMC,,V,,,,,,,,,", "GPGGA,214106,3707.8178,N,12139.2690,W,1,8,0.9,5.0,M",
        "GPRMC", "", "GPRMC,214106,A,3767.8178,N,12139.2690,W,1,1,320715", "GPRMC,2x4106,A",
        "GPRMC,2141,A,.,N,.,W,010.3,188.2,230715"}) {
    const auto packet = parse_position_packet(packet_with(with_checksum(body)));
    ASSERT_TRUE(packet) << body;
    EXPECT_FALSE(packet->utc_ns) << body;
    EXPECT_FALSE(packet->fix) << body;
  }
}

TEST(PositionPacket, SaysNothingOfASentenceThatIsDamaged) {
  const std::string sound = with_checksum(kSentence);
  for (std::size_t length = 0; length < sound.size() - 2; ++length) {
    const auto packet = parse_position_packet(packet_with(sound.substr(0, length)));
    ASSERT_TRUE(packet);
    EXPECT_FALSE(packet->fix) << length;
  }
  for (std::size_t at = 0; at < sound.size() - 2; ++at) {
    std::string damaged = sound;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    EXPECT_FALSE(parse_position_packet(packet_with(damaged))->fix) << at;
  }
}

TEST(PositionPacket, IsNotWhatHasAnotherSizeOrTime) {
  EXPECT_FALSE(parse_position_packet(std::vector<std::byte>(511)));
  EXPECT_FALSE(parse_position_packet(std::vector<std::byte>(1206)));
  EXPECT_FALSE(parse_position_packet(packet_with("", 3'601'000'001)));
  std::mt19937_64 random(3);
  std::vector<std::byte> bytes(512);
  for (int i = 0; i < 20'000; ++i) {
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    if (const auto packet = parse_position_packet(bytes)) {
      EXPECT_FALSE(packet->fix);
    }
  }
}

TEST(PositionPacket, LeavesItsFixWithTheDecoderUntilTheNextOne) {
  const SensorModel& model = *find_sensor_model("vlp16");
  BlockDecoder decoder(kVlp16, model.beams, {});
  std::array<Point, 2> storage;
  SweepPair sweeps(storage);
  EXPECT_FALSE(decoder.position());
  const auto decode = [&](std::span<const std::byte> payload) {
    EXPECT_EQ(decoder.decode({payload, kSentenceUtcNs}, sweeps).status, DecodeStatus::telemetry);
  };
  decode(packet_with(with_checksum(kSentence)));
  ASSERT_TRUE(decoder.position());
  EXPECT_NEAR(decoder.position()->course_deg, 188.2, 1e-9);
  decode(packet_with(""));
  EXPECT_FALSE(decoder.position()) << "the receiver is silent: where it was is not where it is";
}

TEST(PositionPacket, TellsTheDecoderUtcWhereTheReceiversClockIsHoursOff) {
  // The computer's clock is 5 h slow.
  const std::int64_t utc_ns = kSentenceUtcNs + 1'110'195'000;
  const std::int64_t slow_ns = 5 * 3'600'000'000'000;
  test::DecoderBench bench("vlp16");
  EXPECT_EQ(bench.decode(packet_with(with_checksum(kSentence)), utc_ns - slow_ns).status,
            DecodeStatus::telemetry);
  test::VelodynePacket data;
  data.set_azimuths(1000, 40);
  data.set_return(0, 0, 1000);
  data.set_time_us(2'467'120'000);
  EXPECT_EQ(bench.decode(data.bytes(), utc_ns - slow_ns + 10'000'000).status, DecodeStatus::decoded);
  ASSERT_TRUE(bench.flush());
  EXPECT_EQ(bench.swept()[0].start_utc_ns, utc_ns + 9'805'000);
  EXPECT_EQ(bench.swept()[0].time_source, TimeSource::sensor);
}

}  // namespace
}  // namespace landfix::drivers::velodyne
