// landfixd on a real interface: packets from the network, poses on vcan0.
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "guest/guest_commands.hpp"
#include "platform/candump_log.hpp"
#include "platform/pcap_source.hpp"
#include "platform/pcap_writer.hpp"
#include "platform/socket_can.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

using testing::HasSubstr;

void sleep_s(double s) { std::this_thread::sleep_for(std::chrono::duration<double>(s)); }

/// The guest's one CPU, whose system calls are dear, keeps pace with a third of the packets.
void thin_out(const std::string& from, const std::string& to) {
  PcapSource source(from);
  PcapWriter thinned(to);
  UdpPacket packet;
  for (std::size_t i = 0; source.next(packet) == ReadStatus::packet; ++i) {
    if (i % 3 != 0) continue;
    thinned.write({.source_address = packet.source_address, .destination_port = packet.destination_port},
                  packet.payload, packet.receive_utc_ns);
  }
  thinned.commit();
}

/// The first seconds of a drive on the circuit, simulated once.
class Daemon : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (SocketCan("vcan0", false).status().state == BusState::missing) return;
    directory_ = std::make_unique<test::TemporaryDirectory>();
    test::run(LANDFIX_PROGRAM " simulate --route circuit --length 110 --sensor vlp16 --output " + path("") +
              " >" + path("simulate.out"));
    test::run(LANDFIX_PROGRAM " map --pcd " + path("map.pcd") +
              " --resolution 1 --capacity 400000 --output " + path("map.ndt") + " >" + path("map.out"));
    thin_out(path("capture.pcap"), path("thin.pcap"));
    test::run("sed -i '/^\\[sensor\\]/a address = \"127.0.0.9\"' " + path("config.toml"));
    std::ofstream(path("config.toml"), std::ios::app)
        << "\n[can]\ninterface = \"vcan0\"\nrate_hz = 20.0\n[metrics]\naddress = \"127.0.0.1:9464\"\n";
  }
  static void TearDownTestSuite() { directory_.reset(); }
  void SetUp() override {
    if (!directory_) GTEST_SKIP() << "no vcan0 here: ./check can";
  }

  [[nodiscard]] static std::string path(const std::string& name) {
    return (directory_->path() / name).string();
  }
  [[nodiscard]] static std::string daemon() {
    return LANDFIXD_PROGRAM " --config " + path("config.toml") + " 2>" + path("daemon.out");
  }
  [[nodiscard]] static std::string play() {
    return LANDFIX_PROGRAM " play --pcap " + path("thin.pcap") + " --to 127.0.0.1 --from 127.0.0.9 >" +
           path("play.out");
  }
  /// Of the last play.
  [[nodiscard]] static bool was_in_time() {
    constexpr double kLate_ms = 200.0;
    const std::string said = test::text_of(path("play.out"));
    const std::size_t late = said.find("late by ");
    return late != std::string::npos && std::stod(said.substr(late + 8)) < kLate_ms;
  }
  /// What `landfix can decode` says of the frames that candump saw.
  [[nodiscard]] static nlohmann::json decoded() {
    test::run(LANDFIX_PROGRAM " can decode " + path("bus.log") + " --json >" + path("decoded.json"));
    return nlohmann::json::parse(test::text_of(path("decoded.json")));
  }
  [[nodiscard]] static std::size_t count(const nlohmann::json& report, const std::string& state) {
    std::size_t poses = 0;
    for (const nlohmann::json& pose : report["poses"]) poses += pose["state"] == state ? 1U : 0U;
    return poses;
  }

 private:
  static inline std::unique_ptr<test::TemporaryDirectory> directory_;
};

TEST_F(Daemon, PublishesOnTheBusAtItsRate) {
  test::Background dump("stdbuf -oL candump -r 4000000 -L vcan0 >" + path("bus.log"));
  test::Background daemon_process(daemon());
  sleep_s(2.0);
  test::run(play());
  test::run(LANDFIX_PROGRAM " top --once --json >" + path("top.json"));
  sleep_s(0.5);
  daemon_process.stop();
  if (!was_in_time()) GTEST_SKIP() << "the guest cannot keep pace: " << test::text_of(path("play.out"));
  sleep_s(0.3);
  dump.stop();
  EXPECT_EQ(daemon_process.exit_code(), 0) << test::text_of(path("daemon.out"));
  const nlohmann::json report = decoded();
  for (const char* const fault : {"wrong_crc", "repeated", "lost", "wrong_sequence", "out_of_order"}) {
    EXPECT_EQ(report["fault_counts"][fault], 0) << fault;
  }
  EXPECT_GT(count(report, "TRACKING"), 100U) << test::text_of(path("daemon.out"));
  EXPECT_EQ(report["poses"].back()["state"], "NO_DATA") << "the last that is said";
  // 20 a second, in order, over all of it.
  const auto& poses = report["poses"];
  const double seconds = 1e-9 * static_cast<double>(poses.back()["stamp_utc_ns"].get<std::int64_t>() -
                                                    poses.front()["stamp_utc_ns"].get<std::int64_t>());
  EXPECT_NEAR(static_cast<double>(poses.size()) / seconds, 20.0, 3.0);
  EXPECT_EQ(nlohmann::json::parse(test::text_of(path("top.json")))["can"]["state"], "up");
}

TEST_F(Daemon, ComesBackWithTheInterface) {
  test::Background daemon_process(daemon());
  test::run("candump -n 1 -T 20000 vcan0 >" + path("first.log"));  // however slow the guest is
  ASSERT_NE(test::text_of(path("first.log")), "") << test::text_of(path("daemon.out"));
  test::run("ip link set vcan0 down");
  sleep_s(0.5);
  test::run("ip link set vcan0 up");
  test::Background dump("stdbuf -oL candump -r 4000000 -L vcan0 >" + path("bus.log"));
  sleep_s(1.2);
  dump.stop();
  daemon_process.stop();
  EXPECT_GT(decoded()["poses"].size(), 4U) << "within a second";
  EXPECT_THAT(test::text_of(path("daemon.out")), HasSubstr("vcan0"));
}

/// Without its first seconds.
void cut_begin(const std::string& from, const std::string& to, double seconds) {
  CandumpLog cut(to, "can0");
  const std::vector<StampedFrame> frames = read_candump(from);
  for (const StampedFrame& each : frames) {
    if (static_cast<double>(each.stamp_utc_ns - frames.front().stamp_utc_ns) * 1e-9 < seconds) continue;
    (void)cut.send({&each.frame, 1}, each.stamp_utc_ns);
  }
  cut.commit();
}

TEST_F(Daemon, UsesOdometryOfTheBus) {
  // The log begins half a second before the drive; the daemon says that it tracks a quarter of one after.
  cut_begin(path("odometry.log"), path("vehicle.log"), 0.75);
  test::Background daemon_process(daemon());
  sleep_s(2.0);
  test::Background sensor(play());
  while (test::text_of(path("daemon.out")).find("-> TRACKING") == std::string::npos && !sensor.has_ended())
    sleep_s(0.01);
  test::Background vehicle("canplayer -I " + path("vehicle.log") + " vcan0=can0");
  bool is_speed_believed = false;
  bool is_yaw_rate_believed = false;
  nlohmann::json odometry;
  while (!sensor.has_ended()) {
    sleep_s(2.0);
    test::run(LANDFIX_PROGRAM " top --once --json >" + path("top.json"));
    odometry = nlohmann::json::parse(test::text_of(path("top.json")))["odometry"];
    is_speed_believed |= odometry["speed_believed"] == true;
    is_yaw_rate_believed |= odometry["yaw_rate_believed"] == true;
  }
  daemon_process.stop();
  if (!was_in_time()) GTEST_SKIP() << "the guest cannot keep pace: " << test::text_of(path("play.out"));
  EXPECT_GT(odometry["frames"], 2000) << odometry;
  EXPECT_TRUE(is_speed_believed) << odometry;
  EXPECT_TRUE(is_yaw_rate_believed) << odometry;
}

}  // namespace
}  // namespace landfix::platform
