// `landfix can decode` on a real interface.
#include <chrono>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "guest/guest_commands.hpp"
#include "platform/pose_frames.hpp"
#include "platform/socket_can.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

using testing::HasSubstr;

class CanDecode : public testing::Test {
 protected:
  void SetUp() override {
    if (bus_.status().state == BusState::missing) GTEST_SKIP() << "no vcan0 here: ./check can";
  }
  /// Sends 50 poses a second while the command goes on, for at most 20 s.
  void send_poses_to(test::Background& command) {
    PoseFrameEncoder encoder(0x3A0, false, true);
    PoseReport report;
    report.state = 5;
    report.latitude_deg = 49.0;
    report.longitude_deg = 8.4;
    for (int i = 0; i < 1000 && !command.has_ended(); ++i) {
      report.stamp_utc_ns = 1'700'000'000'000'000'000 + i * 20'000'000LL;
      report.x_m = i;
      const PoseFrames frames = encoder.encode(report);
      (void)bus_.send(frames.all(), 0);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ASSERT_TRUE(command.has_ended());
  }

  SocketCan bus_{"vcan0", false};
  test::TemporaryDirectory directory_;
  std::filesystem::path out_ = directory_.path() / "out";
};

TEST_F(CanDecode, PrintsSoManyPosesOfTheBusAsTheyCome) {
  test::Background decode(LANDFIX_PROGRAM " can decode vcan0 --json --count 20 >" + out_.string());
  send_poses_to(decode);
  EXPECT_EQ(decode.exit_code(), 0);
  const std::string json = test::text_of(out_);
  for (const char* const fault :
       {"wrong_crc", "repeated", "lost", "wrong_sequence", "out_of_order", "silence"}) {
    EXPECT_THAT(json, HasSubstr(std::string("\"") + fault + "\": 0"));
  }
  std::size_t poses = 0;
  for (std::size_t at = 0; (at = json.find("\"x_m\"", at)) != std::string::npos; ++at) ++poses;
  EXPECT_EQ(poses, 20U);
  EXPECT_THAT(json, HasSubstr("\"latitude_deg\": 4"));
}

TEST_F(CanDecode, EndsAfterATimeAndOnCtrlC) {
  test::Background timed(LANDFIX_PROGRAM " can decode vcan0 --seconds 1 >" + out_.string());
  send_poses_to(timed);
  EXPECT_EQ(timed.exit_code(), 0);
  EXPECT_THAT(test::text_of(out_), HasSubstr("TRACKING"));
  EXPECT_THAT(test::text_of(out_), HasSubstr("poses in"));

  test::Background endless(LANDFIX_PROGRAM " can decode vcan0 2>" + out_.string());
  std::this_thread::sleep_for(std::chrono::seconds(3));  // until it surely listens
  endless.stop();
  EXPECT_EQ(endless.exit_code(), 1);
  EXPECT_THAT(test::text_of(out_), HasSubstr("no pose at base id 0x3A0 among 0 frames"));
}

TEST_F(CanDecode, SaysThatThereIsNoSuchInterface) {
  test::Background decode(LANDFIX_PROGRAM " can decode vcan7 2>" + out_.string());
  while (!decode.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(decode.exit_code(), 1);
  EXPECT_THAT(test::text_of(out_), HasSubstr("vcan7: no such interface"));
}

}  // namespace
}  // namespace landfix::platform
