#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "platform/monotonic_clock.hpp"
#include "platform/pcap_writer.hpp"
#include "platform/udp_receiver.hpp"
#include "support/frames.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"

namespace landfix::tools {
namespace {

using platform::PacketRing;
using platform::ReceiveStatus;
using platform::UdpReceiver;
using test::Bytes;
using testing::HasSubstr;

constexpr std::int64_t kStart_utc_ns = 1'700'000'000'000'000'000;
constexpr std::uint32_t kSensor = 0x7F000009;  // 127.0.0.9
constexpr std::size_t kLargest_bytes = 33'024;

class PlayCommand : public testing::Test {
 protected:
  /// Packets of these sizes a millisecond apart; every fourth goes to the receiver's second port.
  void write(const std::vector<std::size_t>& sizes, std::uint16_t data_port, std::uint16_t other_port) {
    platform::PcapWriter writer(path_);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const bool is_other = i % 4 == 3;
      payloads_.push_back(test::payload(sizes[i], static_cast<unsigned>(i)));
      writer.write({.source_address = kSensor,
                    .source_port = 2368,
                    .destination_port = is_other ? other_port : data_port},
                   payloads_.back(), kStart_utc_ns + static_cast<std::int64_t>(i) * 1'000'000);
    }
    writer.commit();
  }

  test::Outcome play(const std::string& to, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"play", "--pcap", path_, "--to", to};
    words.insert(words.end(), more.begin(), more.end());
    return test::run_landfix(words);
  }

  /// What has come, one port after the other.
  static std::vector<Bytes> received(UdpReceiver& receiver) {
    PacketRing ring(kLargest_bytes, 256);
    while (receiver.receive(ring, platform::monotonic_ns() + 20'000'000) == ReceiveStatus::packets) {
    }
    std::vector<Bytes> result;
    for (; ring.waiting(1) != 0; ring.free()) {
      const auto payload = ring.front().payload;
      result.emplace_back(payload.begin(), payload.end());
    }
    return result;
  }

  /// Of the packets that were written: those of one port, in order, as often as there were laps.
  std::vector<Bytes> written(bool to_other_port, int laps = 1) const {
    std::vector<Bytes> result;
    for (int lap = 0; lap < laps; ++lap) {
      for (std::size_t i = 0; i < payloads_.size(); ++i) {
        if ((i % 4 == 3) == to_other_port) result.push_back(payloads_[i]);
      }
    }
    return result;
  }

  test::TemporaryDirectory directory_;
  std::string path_ = directory_.path() / "drive.pcap";
  std::vector<Bytes> payloads_;
};

const std::vector<std::size_t> kSizes{1206, 1206, 33'024, 512, 12'608, 1, 1206, 554, 1206, 0};

TEST_F(PlayCommand, SendsThePayloadsInOrderToTheirPortsFromTheSensorsAddress) {
  UdpReceiver data({.ports = {0}, .sensor_address = kSensor});
  UdpReceiver other({.ports = {0}});
  write(kSizes, data.port(0), other.port(0));
  const auto outcome = play("127.0.0.1", {"--json"});
  EXPECT_EQ(outcome.error, "");
  ASSERT_EQ(outcome.code, 0);
  const auto object = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(object["packets"], 10);
  EXPECT_EQ(object["bytes"], 4 * 1206 + 33'024 + 512 + 12'608 + 1 + 554);
  EXPECT_EQ(object["not_sent"], 0);
  EXPECT_GE(object["seconds"], 0.009);
  EXPECT_GE(object["late_ms"]["max"], 0.0);
  EXPECT_EQ(received(data), written(false));
  EXPECT_EQ(received(other), written(true));
  EXPECT_EQ(data.counters().strangers, 0U);
}

TEST_F(PlayCommand, PutsAPortInPlaceOfTheDatas) {
  UdpReceiver data({.ports = {0}});
  UdpReceiver other({.ports = {0}});
  write(kSizes, 2368, other.port(0));
  ASSERT_EQ(play(fmt::format("localhost:{}", data.port(0))).code, 0);
  EXPECT_EQ(received(data), written(false));
  EXPECT_EQ(received(other), written(true));
}

TEST_F(PlayCommand, PlaysLapsAsFastAsItGoesFromAnotherAddress) {
  UdpReceiver data({.ports = {0}, .sensor_address = 0x7F000005});
  UdpReceiver other({.ports = {0}});
  write(kSizes, data.port(0), other.port(0));
  const auto outcome = play("127.0.0.1", {"--from", "127.0.0.5", "--speed", "0", "--loop", "3"});
  ASSERT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("30 packets"));
  EXPECT_EQ(received(data), written(false, 3));
  EXPECT_EQ(received(other), written(true, 3));
}

TEST_F(PlayCommand, SaysWhatItCannotDo) {
  EXPECT_EQ(play("127.0.0.1").code, 1);  // no such file
  write({100}, 2368, 2368);
  EXPECT_EQ(play("127.0.0.1:x").code, 2);
  EXPECT_EQ(play("127.0.0.1:0").code, 2);
  EXPECT_EQ(play("127.0.0.1:65536").code, 2);
  EXPECT_EQ(play("127.0.0.1", {"--speed", "-1"}).code, 2);
  EXPECT_EQ(play("127.0.0.1", {"--loop", "0"}).code, 2);
  const auto nobody = play("127.0.0.1", {"--from", "203.0.113.1"});
  EXPECT_EQ(nobody.code, 1);
  EXPECT_THAT(nobody.error, HasSubstr("ip addr add 203.0.113.1/24"));
  const auto no_host = play("no-such-host.invalid");
  EXPECT_EQ(no_host.code, 2);
  EXPECT_THAT(no_host.error, HasSubstr("--to no-such-host.invalid"));
}

TEST_F(PlayCommand, TellsAnEmptyCapture) {
  write({}, 0, 0);
  for (const char* const to : {"127.0.0.1", "127.0.0.1:2368"}) {
    const auto outcome = play(to);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.error, HasSubstr("no UDP packet in it"));
  }
}

TEST_F(PlayCommand, PlaysWhatThereIsOfACaptureThatIsCutOff) {
  UdpReceiver data({.ports = {0}});
  write({100, 100, 100}, data.port(0), data.port(0));
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 1);
  const auto outcome = play("127.0.0.1");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.error, HasSubstr("cut off"));
  EXPECT_THAT(outcome.out, HasSubstr("2 packets"));
}

}  // namespace
}  // namespace landfix::tools
