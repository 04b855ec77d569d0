#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "platform/pcap_writer.hpp"
#include "support/hdl64_packets.hpp"
#include "support/hdl64_status_stream.hpp"
#include "support/robosense_packets.hpp"
#include "support/run_landfix.hpp"
#include "support/synthetic_packets.hpp"
#include "support/test_data.hpp"

namespace landfix::tools {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kHourUtcNs = 1'700'002'800'000'000'000;
constexpr std::int64_t kPacketNs = 1'327'104;

class DecodeCommand : public testing::Test {
 protected:
  /// 200 single-return packets, 2.65 turns, each slot 10 m away.
  void record_vlp16(std::uint8_t product = 0x22, std::uint16_t port = 2368) {
    platform::PcapWriter capture(pcap_);
    for (unsigned i = 0; i < 200; ++i) {
      test::VelodynePacket packet(product);
      packet.set_azimuths(480 * i % 36000, 40);
      packet.set_time_us(static_cast<std::uint32_t>(i * kPacketNs / 1000));
      for (std::size_t block = 0; block < 12; ++block) {
        for (std::size_t slot = 0; slot < 32; ++slot) packet.set_return(block, slot, 5000, 9);
      }
      capture.write({.destination_port = port}, packet.bytes(), kHourUtcNs + i * kPacketNs);
    }
    capture.write({.destination_port = port}, std::vector<std::byte>(1205), kHourUtcNs + 200 * kPacketNs);
    capture.write({.destination_port = 8308}, std::vector<std::byte>(512), kHourUtcNs);
    capture.commit();
  }

  /// Of an RS-LiDAR-32, which says at the end only where its lasers point.
  void record_rs32() {
    platform::PcapWriter capture(pcap_);
    for (unsigned i = 0; i < 20; ++i) {
      test::RobosensePacket packet("rs32");
      packet.set_azimuths(240 * i, 20);
      packet.set_time_us(i * 666);
      packet.set_return(0, 0, 2000, 9);
      capture.write({.destination_port = 6699}, packet.bytes(),
                    test::RobosensePacket::kTimeUtcNs + i * std::int64_t{666'000});
    }
    capture.write({.destination_port = 7788}, test::robosense_unit("rs32").bytes(),
                  test::RobosensePacket::kTimeUtcNs + 20 * std::int64_t{666'000});
    capture.commit();
  }

  /// A position packet of a VLP-16. `status`: A where the receiver has a fix, else V.
  static std::vector<std::byte> position_packet(char status) {
    const std::string body =
        std::string("GPRMC,221321,") + status + ",4807.038,N,01131.000,E,022.4,084.4,141123,003.1,W";
    unsigned sum = 0;
    for (const char c : body) sum ^= static_cast<unsigned char>(c);
    const std::string sentence = fmt::format("${}*{:02X}\r\n", body, sum);
    std::vector<std::byte> packet(512);
    std::ranges::transform(sentence, packet.begin() + 206, [](char c) { return static_cast<std::byte>(c); });
    return packet;
  }

  int decode(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"decode", "--pcap", pcap_, "--output", output_};
    words.insert(words.end(), more.begin(), more.end());
    test::Outcome outcome = test::run_landfix(words);
    out_ = std::move(outcome.out);
    error_ = std::move(outcome.error);
    return outcome.code;
  }

  test::TemporaryDirectory directory_;
  std::filesystem::path pcap_ = directory_.path() / "capture.pcap";
  std::filesystem::path output_ = directory_.path() / "sweeps" / "of the drive";
  std::string out_;
  std::string error_;
};

TEST_F(DecodeCommand, NamesTheSensorAndWritesOneFileASweep) {
  record_vlp16();
  ASSERT_EQ(decode(), 0) << error_;
  EXPECT_THAT(error_, HasSubstr("VLP-16"));
  EXPECT_THAT(out_, HasSubstr("200 packets decoded, 1 rejected, 0 lost, 1 of telemetry, 0 to other ports"));
  EXPECT_THAT(out_, HasSubstr("3 sweeps, 1 complete"));
  for (const char* const name : {"0000.pcd", "0001.pcd", "0002.pcd"}) {
    EXPECT_TRUE(std::filesystem::exists(output_ / name)) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(output_ / "0003.pcd"));
}

TEST_F(DecodeCommand, PrintsOneJsonObjectWithTheKeysOfTheDesign) {
  record_vlp16();
  ASSERT_EQ(decode({"--json", "--sensor", "vlp16"}), 0) << error_;
  const auto object = nlohmann::json::parse(out_);
  EXPECT_EQ(object.at("sensor"), "vlp16");
  EXPECT_EQ(object.at("packets").at("total"), 201);
  EXPECT_EQ(object.at("packets").at("decoded"), 200);
  EXPECT_EQ(object.at("packets").at("rejected"), 1);
  const auto& sweeps = object.at("sweeps");
  ASSERT_EQ(sweeps.size(), 3U);
  EXPECT_EQ(sweeps[1].at("index"), 1);
  EXPECT_EQ(sweeps[1].at("complete"), true);
  EXPECT_EQ(sweeps[1].at("points"), 900 * 32);
  EXPECT_NEAR(sweeps[1].at("first_time").get<double>(), 1'700'002'800.0995328, 1e-6);
  EXPECT_NEAR(sweeps[1].at("last_time").get<double>(), 1'700'002'800.0995328 + 0.0995328 - 20.736e-6, 1e-6);
  EXPECT_EQ(sweeps[2].at("complete"), false);
}

TEST_F(DecodeCommand, CutsWhereItIsTold) {
  record_vlp16();
  ASSERT_EQ(decode({"--json", "--cut-deg", "180"}), 0) << error_;
  const auto sweeps = nlohmann::json::parse(out_).at("sweeps");
  ASSERT_EQ(sweeps.size(), 4U);
  EXPECT_EQ(sweeps[0].at("points"), 450 * 32);
}

TEST_F(DecodeCommand, WritesTextForSpreadsheets) {
  record_vlp16();
  ASSERT_EQ(decode({"--format", "csv"}), 0) << error_;
  std::ifstream file(output_ / "0000.csv");
  std::string header;
  std::string first;
  std::getline(file, header);
  std::getline(file, first);
  EXPECT_EQ(header, "x,y,z,intensity,ring,time");
  EXPECT_THAT(first, testing::StartsWith("9.659258,0.000000,-2.5769"));
  EXPECT_THAT(first, testing::EndsWith(",9,0,0.000000000"));
}

TEST_F(DecodeCommand, FindsTheSensorAtAnotherPort) {
  record_vlp16(0x24, 4000);
  ASSERT_EQ(decode({"--json"}), 0) << error_;
  EXPECT_EQ(nlohmann::json::parse(out_).at("sensor"), "vlp16hires");
}

TEST_F(DecodeCommand, SaysWhatACaptureHoldsInsteadOfTheSensor) {
  record_vlp16();
  EXPECT_EQ(decode({"--sensor", "pandar64"}), 1);
  EXPECT_THAT(error_, HasSubstr("200 UDP packets of 1206 bytes to port 2368"));
  EXPECT_THAT(error_, HasSubstr("it could be vlp16"));
  EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(DecodeCommand, ListsTheCandidatesWhereThereAreSeveral) {
  platform::PcapWriter capture(pcap_);
  capture.write({.destination_port = 2368}, test::VelodynePacket().bytes(), kHourUtcNs);
  capture.write({.destination_port = 2369}, test::Pandar64Packet().bytes(), kHourUtcNs);
  capture.commit();
  EXPECT_EQ(decode(), 2);
  EXPECT_THAT(error_, HasSubstr("could be vlp16, pandar64; choose with --sensor"));
}

TEST_F(DecodeCommand, ListsTheModelsWhoseDataPacketsAreAlike) {
  record_rs32();
  EXPECT_EQ(decode(), 2);
  EXPECT_THAT(error_, HasSubstr("could be rs32, rs16; choose with --sensor"));
}

TEST_F(DecodeCommand, LosesNoPacketOfASensorThatSaysLaterWhereItsLasersPoint) {
  record_rs32();
  ASSERT_EQ(decode({"--json", "--sensor", "rs32"}), 0) << error_;
  const auto packets = nlohmann::json::parse(out_).at("packets");
  EXPECT_EQ(packets.at("decoded"), 20);
  EXPECT_EQ(packets.at("rejected"), 0);
}

TEST_F(DecodeCommand, LosesNoPacketOfAnHdl64ThatSendsItsCalibrationByteByByte) {
  constexpr std::int64_t kHdl64PacketNs = 288'000;
  platform::PcapWriter capture(pcap_);
  const auto sent = test::sent_set();
  for (std::size_t i = 0; i < sent.size(); ++i) {
    auto packet = test::hdl64_packet(static_cast<unsigned>(104 * i % 36000), 17);
    packet.set_time_us(static_cast<std::uint32_t>(i * 288));
    packet.set_return(0, 0, 5000, 9);
    packet.set_mode(sent[i].type);
    packet.set_product(sent[i].value);
    capture.write({.destination_port = 2368}, packet.bytes(),
                  kHourUtcNs + static_cast<std::int64_t>(i) * kHdl64PacketNs);
  }
  capture.commit();
  ASSERT_EQ(decode({"--json", "--sensor", "hdl64s2"}), 0) << error_;
  const auto packets = nlohmann::json::parse(out_).at("packets");
  EXPECT_EQ(packets.at("decoded"), sent.size());
  EXPECT_EQ(packets.at("rejected"), 0);
}

TEST_F(DecodeCommand, NamesTheOtherModelWhereTheUnitSaysThatItIsAnother) {
  record_rs32();
  EXPECT_EQ(decode({"--sensor", "rs16"}), 1);
  EXPECT_THAT(error_, HasSubstr("another sensor model"));
  EXPECT_THAT(error_, HasSubstr("it could be rs32"));
}

TEST_F(DecodeCommand, ShowsWhereTheReceiverAtTheSensorIs) {
  record_vlp16();
  ASSERT_EQ(decode({"--json"}), 0) << error_;
  EXPECT_TRUE(nlohmann::json::parse(out_).at("position").is_null());
  for (const char status : {'A', 'V'}) {
    platform::PcapWriter capture(pcap_);
    capture.write({.destination_port = 2368}, test::VelodynePacket().bytes(), kHourUtcNs);
    capture.write({.destination_port = 8308}, position_packet('A'), kHourUtcNs);
    capture.write({.destination_port = 8308}, position_packet(status), kHourUtcNs);
    capture.commit();
    ASSERT_EQ(decode({"--json"}), 0) << error_;
    const auto position = nlohmann::json::parse(out_).at("position");
    EXPECT_NEAR(position.at("latitude_deg").get<double>(), 48.1173, 1e-9);
    EXPECT_NEAR(position.at("longitude_deg").get<double>(), 11.5 + 1.0 / 60.0, 1e-9);
    EXPECT_EQ(position.at("valid"), status == 'A');
  }
  ASSERT_EQ(decode(), 0) << error_;
  EXPECT_THAT(out_, HasSubstr("receiver at the sensor: 48.117300, 11.516667 deg; it lost its fix later"));
}

TEST_F(DecodeCommand, RefusesWhatItCannotUse) {
  platform::PcapWriter empty(pcap_);
  empty.commit();
  EXPECT_EQ(decode(), 2);
  EXPECT_THAT(error_, HasSubstr("no sensor recognised in no UDP packet"));
  EXPECT_EQ(decode({"--sensor", "vlp17"}), 2);
  EXPECT_THAT(error_, HasSubstr("no sensor 'vlp17'"));
  EXPECT_EQ(decode({"--format", "xyz"}), 2);
  record_vlp16();
  EXPECT_EQ(decode({"--calibration", "unit.csv"}), 2);
  EXPECT_THAT(error_, HasSubstr("vlp16 takes no calibration"));
  std::filesystem::remove(pcap_);
  EXPECT_EQ(decode(), 1);
}

TEST_F(DecodeCommand, SaysThatNothingCouldBeDecoded) {
  platform::PcapWriter capture(pcap_);
  test::VelodynePacket packet;
  packet.set_azimuth(3, 36000);
  capture.write({.destination_port = 2368}, packet.bytes(), kHourUtcNs);
  capture.commit();
  EXPECT_EQ(decode({"--sensor", "vlp16"}), 1);
  EXPECT_THAT(error_, HasSubstr("none of 1 packets of vlp16 could be decoded: 1 x azimuth"));
  EXPECT_EQ(out_, "");
}

TEST_F(DecodeCommand, WarnsOfSweepsThatAnEarlierRunLeft) {
  record_vlp16();
  ASSERT_EQ(decode(), 0);
  EXPECT_THAT(error_, testing::Not(HasSubstr("earlier run")));
  std::ofstream(output_ / "0003.pcd") << "of an earlier run";
  ASSERT_EQ(decode(), 0);
  EXPECT_THAT(error_, HasSubstr("also holds 1 sweeps of an earlier run"));
}

TEST_F(DecodeCommand, SaysWhatTheRecordingLost) {
  record_vlp16();
  std::string capture;
  {
    std::ifstream file(pcap_, std::ios::binary);
    capture.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  capture[24 + 16 + 14] = 0x46;  // the first IP header claims to be longer: its UDP length no longer fits
  std::ofstream(pcap_, std::ios::binary) << capture;
  EXPECT_EQ(decode(), 0);
  EXPECT_THAT(error_, HasSubstr("left out: 1 malformed frames"));
}

TEST(SensorsCommand, ListsTheCatalogue) {
  const test::Outcome outcome = test::run_landfix({"sensors", "--json"});
  EXPECT_EQ(outcome.code, 0);
  const auto object = nlohmann::json::parse(outcome.out);
  std::map<std::string, nlohmann::json> sensors;
  for (const auto& sensor : object.at("sensors")) sensors[sensor.at("name")] = sensor;
  EXPECT_EQ(sensors["vlp16"].at("beams"), 16);
  EXPECT_EQ(sensors["vlp16"].at("calibration"), "none");
  EXPECT_EQ(sensors["pandar64"].at("calibration"), "optional");
  EXPECT_EQ(sensors["rs32"].at("calibration"), "in_stream");
  EXPECT_EQ(sensors["os1-64"].at("calibration"), "required");
}

}  // namespace
}  // namespace landfix::tools
