// The main job, end to end, on a drive whose truth is exact: simulate, build the map, replay, compare.
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ndt/map_file.hpp"
#include "ndt/scan_filter.hpp"
#include "platform/atomic_file.hpp"
#include "platform/candump_log.hpp"
#include "platform/e2e.hpp"
#include "platform/pcap_source.hpp"
#include "platform/pose_frames.hpp"
#include "platform/trajectory.hpp"
#include "support/interrupted_source.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"
#include "tools/replay_run.hpp"
#include "tools/replay_setup.hpp"

namespace landfix::tools {
namespace {

using testing::HasSubstr;

using test::Outcome;

Outcome landfix(const std::vector<std::string>& words) { return test::run_landfix(words); }

/// 120 m of the street, simulated once for all tests.
class SimulatedDrive : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = std::make_unique<test::TemporaryDirectory>();
    const Outcome simulated = landfix(
        {"simulate", "--route", "street", "--length", "120", "--sensor", "vlp16", "--output", path("")});
    ASSERT_EQ(simulated.code, 0) << simulated.error;
    const Outcome mapped = landfix(
        {"map", "--pcd", path("map.pcd"), "--resolution", "1", "--output", path("map.ndt"), "--json"});
    ASSERT_EQ(mapped.code, 0) << mapped.error;
    const auto map = nlohmann::json::parse(mapped.out);
    EXPECT_LE(map["bytes"].get<double>(), 96.0 * map["voxels"].get<double>()) << "the index included";
  }
  static void TearDownTestSuite() { directory_.reset(); }

  [[nodiscard]] static std::string path(const std::string& name) {
    return (directory_->path() / name).string();
  }

  [[nodiscard]] static Outcome replay(std::vector<std::string> more = {}) {
    std::vector<std::string> words{"replay", "--config", path("config.toml")};
    words.insert(words.end(), more.begin(), more.end());
    return landfix(words);
  }
  [[nodiscard]] static nlohmann::json replay_against_truth(std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--truth", path("truth.tum"), "--json"});
    const Outcome outcome = replay(more);
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    return nlohmann::json::parse(outcome.out);
  }

 private:
  static inline std::unique_ptr<test::TemporaryDirectory> directory_;
};

TEST_F(SimulatedDrive, IsFollowedToCentimetres) {
  const nlohmann::json report = replay_against_truth();
  const nlohmann::json& errors = report["evaluation"];
  EXPECT_LE(errors["ate_m"]["rmse"], 0.05);
  EXPECT_LE(errors["heading_deg"]["rmse"], 0.1);
  EXPECT_LE(errors["elevation_m"]["max"], 0.1);
  EXPECT_GT(report["sweeps"], 100);
  // The velocity of the first is not known, and the capture ends a packet or two into a turn.
  EXPECT_GE(report["tracked"].get<int>() + 2, report["sweeps"].get<int>());
  EXPECT_EQ(report["poses"], report["sweeps"]);
  EXPECT_EQ(report["lost"], 0);
  EXPECT_EQ(report["partial"], 2);  // the first and the last
  EXPECT_EQ(report["time_source"], "sensor");
  EXPECT_EQ(report["packets"]["rejected"], 0);
  RecordProperty("position_rmse_m", errors["ate_m"]["rmse"].dump());
  RecordProperty("heading_rmse_deg", errors["heading_deg"]["rmse"].dump());
}

TEST_F(SimulatedDrive, SaysHowFarOffItMayBe) {
  const nlohmann::json check = replay_against_truth()["nees"];
  EXPECT_GT(check["sweeps"], 100);
  EXPECT_GT(check["mean"], 0.5);
  EXPECT_LT(check["mean"], 2.0);
  for (const char* const axis : {"x", "y", "z", "roll", "pitch", "yaw"}) {
    EXPECT_GT(check[axis], 0.25) << axis;
    EXPECT_LT(check[axis], 4.0) << axis;
  }
}

TEST_F(SimulatedDrive, NeedsDeskew) {
  const double with_m = replay_against_truth()["evaluation"]["ate_m"]["rmse"];
  const double without_m = replay_against_truth({"--no-deskew"})["evaluation"]["ate_m"]["rmse"];
  EXPECT_GT(without_m, 3.0 * with_m);
}

TEST_F(SimulatedDrive, MakesNoHeapCallFromPacketToPose) {
  const nlohmann::json calls = replay_against_truth({"--candump", path("heap.log")})["heap_calls"];
  if (calls.is_null()) GTEST_SKIP() << "heap calls cannot be counted under a sanitizer";
  EXPECT_EQ(calls, 0);
}

TEST_F(SimulatedDrive, IsFollowedWithEveryFilterAndNoHeapCall) {
  const std::string config = test::text_of(path("config.toml"));
  const std::string section = "[filter]\n";
  const std::size_t place = config.find(section) + section.size();
  std::vector<double> points;
  for (const std::string_view kind : ndt::kFilterNames) {
    const std::string name = path(fmt::format("{}.toml", kind));
    std::ofstream(name) << std::string(config).insert(place, fmt::format("kind = \"{}\"\n", kind));
    const Outcome outcome = landfix({"replay", "--config", name, "--truth", path("truth.tum"), "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    const nlohmann::json report = nlohmann::json::parse(outcome.out);
    EXPECT_LE(report["evaluation"]["ate_m"]["rmse"], 0.05) << kind;
    EXPECT_EQ(report["lost"], 0) << kind;
    EXPECT_EQ(report["points_dropped"]["filter_full_or_not_finite"], 0) << kind;
    const nlohmann::json& heap_calls = report["heap_calls"];
    EXPECT_TRUE(heap_calls.is_null() || heap_calls == 0) << kind;
    points.push_back(report["points_mean"]);
  }
  // In the order of the names: the rings tell more points apart, the entropy leaves some out.
  EXPECT_GT(points[1], 1.2 * points[0]);
  EXPECT_LT(points[2], 0.6 * points[0]);
}

TEST_F(SimulatedDrive, ReplaysToTheSameBytes) {
  for (const std::string run : {"1", "2"}) {
    ASSERT_EQ(replay({"--pcap", path("capture.pcap"), "--trajectory", path(run + ".tum"), "--candump",
                      path(run + ".log"), "--svg", path(run + ".svg")})
                  .code,
              0);
  }
  EXPECT_GT(test::text_of(path("1.tum")).size(), 1000U);
  EXPECT_EQ(test::text_of(path("1.tum")), test::text_of(path("2.tum")));
  EXPECT_GT(test::text_of(path("1.log")).size(), 1000U);
  EXPECT_EQ(test::text_of(path("1.log")), test::text_of(path("2.log")));
  EXPECT_EQ(test::text_of(path("1.svg")), test::text_of(path("2.svg")));
}

TEST_F(SimulatedDrive, AnAreaThatTheMapDoesNotShowIsRefused) {
  std::string text = test::text_of(path("config.toml"));
  const std::size_t pose = text.find("\npose = ");
  ASSERT_NE(pose, std::string::npos);
  text.replace(pose, text.find('\n', pose + 1) - pose, "\narea = [100000.0, 0.0, 50.0]");
  std::ofstream(path("away.toml")) << text;
  const Outcome outcome = landfix({"replay", "--config", path("away.toml")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.error.find("shows nothing within 50 m of x 100000, y 0"), std::string::npos)
      << outcome.error;
}

TEST_F(SimulatedDrive, WithAWindowOfTheMapThePosesAreThoseOfTheWholeMap) {
  const double map_mib = static_cast<double>(std::filesystem::file_size(path("map.ndt"))) / (1 << 20);
  const auto write_config = [](const std::string& name, double memory_mib) {
    std::string text = test::text_of(path("config.toml"));
    text.replace(text.find("[map]"), 5, fmt::format("[map]\nmemory_mib = {:.3f}", memory_mib));
    text.replace(text.find("[sensor]"), 8, "[sensor]\nmax_range_m = 20.0");
    std::ofstream(path(name)) << text;
  };
  write_config("whole.toml", 1.1 * map_mib);
  write_config("window.toml", 0.9 * map_mib);  // for two windows
  EXPECT_EQ(prepare_replay({.config = path("whole.toml")}).window, nullptr);
  EXPECT_NE(prepare_replay({.config = path("window.toml")}).window, nullptr);
  for (const std::string name : {"whole", "window"}) {
    const Outcome outcome =
        landfix({"replay", "--config", path(name + ".toml"), "--trajectory", path(name + ".tum"), "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    const auto report = nlohmann::json::parse(outcome.out);
    EXPECT_GE(report["tracked"].get<int>() + 2, report["sweeps"].get<int>());
    EXPECT_TRUE(report["heap_calls"].is_null() || report["heap_calls"] == 0);
  }
  EXPECT_GT(test::text_of(path("whole.tum")).size(), 1000U);
  EXPECT_EQ(test::text_of(path("window.tum")), test::text_of(path("whole.tum")));
}

TEST_F(SimulatedDrive, SendsItsPosesAsProtectedFrames) {
  std::ofstream(path("fd.toml")) << test::text_of(path("config.toml")) << "\n[can]\nfd = true\n";
  for (const std::string config : {"config.toml", "fd.toml"}) {
    ASSERT_EQ(landfix({"replay", "--config", path(config), "--pcap", path("capture.pcap"), "--map",
                       path("map.ndt"), "--trajectory", path("t.tum"), "--candump", path("t.log")})
                  .code,
              0);
    const auto poses = platform::read_tum(path("t.tum"));
    const auto outcome = landfix({"can", "decode", path("t.log"), "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    const auto decoded = nlohmann::json::parse(outcome.out);
    EXPECT_TRUE(decoded["faults"].empty());
    ASSERT_EQ(decoded["poses"].size(), poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const nlohmann::json& sent = decoded["poses"][i];
      const ndt::RollPitchYaw angles = ndt::to_roll_pitch_yaw(poses[i].pose.linear());
      EXPECT_NEAR(sent["x_m"].get<double>(), poses[i].pose.translation().x(), 0.00051);
      EXPECT_NEAR(sent["y_m"].get<double>(), poses[i].pose.translation().y(), 0.00051);
      EXPECT_NEAR(sent["z_m"].get<double>(), poses[i].pose.translation().z(), 0.0051);
      EXPECT_NEAR(sent["yaw_deg"].get<double>(), angles.yaw_rad / ndt::kRadians_per_deg, 0.003);
      EXPECT_NEAR(sent["pitch_deg"].get<double>(), angles.pitch_rad / ndt::kRadians_per_deg, 0.003);
      EXPECT_NEAR(sent["roll_deg"].get<double>(), angles.roll_rad / ndt::kRadians_per_deg, 0.003);
      EXPECT_LE(std::abs(sent["stamp_utc_ns"].get<std::int64_t>() - poses[i].stamp_utc_ns), 5'000);
    }
  }
}

/// A capture with garbage between its packets: on the sensor's port, of its size and of others, and
/// elsewhere.
class GarbageSource final : public platform::PacketSource {
 public:
  explicit GarbageSource(const std::string& path) : source_(path) {}

  [[nodiscard]] platform::ReadStatus next(platform::UdpPacket& packet) noexcept override {
    if (remembered_.payload.empty() || random_() % 2 == 0) {
      const platform::ReadStatus status = source_.next(packet);
      if (status == platform::ReadStatus::packet) remember(packet);
      return status;
    }
    packet = remembered_;
    const std::size_t kind = random_() % 4;
    if (kind == 0) {  // a real packet on another port
      packet.destination_port = 2369;
    } else if (kind == 1) {  // a real packet cut short
      packet.payload = packet.payload.first(random_() % 1206);
    } else {  // noise of the right size, and longer
      for (std::byte& byte : noise_) byte = static_cast<std::byte>(random_());
      packet.payload = std::span(noise_).first(kind == 2 ? 1206 : noise_.size());
    }
    ++garbage_;
    return platform::ReadStatus::packet;
  }
  [[nodiscard]] std::uint64_t garbage() const { return garbage_; }

 private:
  void remember(const platform::UdpPacket& packet) noexcept {
    if (packet.payload.size() != 1206) return;
    std::copy(packet.payload.begin(), packet.payload.end(), copy_.begin());
    remembered_ = packet;
    remembered_.payload = copy_;
  }

  platform::PcapSource source_;
  std::mt19937_64 random_{1};
  std::array<std::byte, 1206> copy_{};
  std::array<std::byte, 1300> noise_{};
  platform::UdpPacket remembered_;
  std::uint64_t garbage_ = 0;
};

TEST_F(SimulatedDrive, GarbageIsCountedAndChangesNoPose) {
  ASSERT_EQ(replay({"--trajectory", path("clean.tum")}).code, 0);
  const ReplaySetup setup = prepare_replay({.config = path("config.toml")});
  platform::Pipeline pipeline(setup.settings, setup.decoder, setup.map(), nullptr);
  GarbageSource source(path("capture.pcap"));
  const ReplayResult result = run_replay(source, pipeline, [](const platform::SweepResult&) {});
  EXPECT_EQ(platform::format_tum(result.trajectory()), test::text_of(path("clean.tum")));
  EXPECT_GT(source.garbage(), 1000U);
  EXPECT_GT(pipeline.counters().rejected(), source.garbage() / 2);
  EXPECT_GT(pipeline.counters().other_ports, source.garbage() / 8);
}

/// A capture of which some packets come twice, and some in the wrong order.
class DisorderedSource final : public platform::PacketSource {
 public:
  explicit DisorderedSource(const std::string& path) : source_(path) {}

  [[nodiscard]] platform::ReadStatus next(platform::UdpPacket& packet) noexcept override {
    if (held_) {
      packet = *std::exchange(held_, std::nullopt);
      return platform::ReadStatus::packet;
    }
    const platform::ReadStatus status = source_.next(packet);
    if (status != platform::ReadStatus::packet || packet.payload.size() != 1206) return status;
    const std::size_t draw = random_() % 100;
    if (draw >= 4) return status;
    std::copy(packet.payload.begin(), packet.payload.end(), copy_.begin());
    held_ = packet;
    held_->payload = copy_;
    return draw < 2 ? status : source_.next(packet);
  }

 private:
  platform::PcapSource source_;
  std::mt19937_64 random_{1};
  std::array<std::byte, 1206> copy_{};
  std::optional<platform::UdpPacket> held_;
};

TEST_F(SimulatedDrive, PacketsThatComeTwiceOrInTheWrongOrderDoNotLoseTheTrack) {
  const ReplaySetup setup = prepare_replay({.config = path("config.toml")});
  platform::Pipeline pipeline(setup.settings, setup.decoder, setup.map(), nullptr);
  DisorderedSource source(path("capture.pcap"));
  const ReplayResult result = run_replay(source, pipeline, [](const platform::SweepResult&) {});
  EXPECT_EQ(result.tally.count(ndt::State::lost), 0U);
  const auto& by_status = pipeline.counters().by_status;
  EXPECT_GT(by_status[static_cast<std::size_t>(drivers::DecodeStatus::duplicate)], 100U);
  // Few are overtaken just where the turn ends; those are lost for their sweep, and no other is.
  EXPECT_LE(pipeline.stream_counters().lost_packets,
            by_status[static_cast<std::size_t>(drivers::DecodeStatus::late)]);
  EXPECT_LT(pipeline.stream_counters().lost_packets, 20U);
  const auto truth = platform::read_tum(path("truth.tum"));
  for (const platform::SweepResult& sweep : result.sweeps) {
    const auto there = platform::interpolate(truth, sweep.fix.at.stamp_utc_ns);
    if (!there || sweep.fix.state != ndt::State::tracking) continue;
    EXPECT_LT((sweep.fix.at.pose.translation() - there->translation()).norm(), 0.3)
        << sweep.fix.at.stamp_utc_ns;
  }
}

/// What was published around a silence of that long.
[[nodiscard]] ReplayResult replay_with_silence(const std::string& directory, double silent_for_s) {
  const ReplaySetup setup = prepare_replay({.config = directory + "config.toml"});
  platform::CandumpLog bus(fmt::format("{}silence{}.log", directory, silent_for_s), "can0");
  platform::Pipeline pipeline(setup.settings, setup.decoder, setup.map(), &bus);
  test::InterruptedSource source(directory + "capture.pcap", 5.03, silent_for_s);
  ReplayResult result = run_replay(source, pipeline, [](const platform::SweepResult&) {});
  bus.commit();
  EXPECT_EQ(pipeline.publish_counters().frames_dropped, 0U);
  EXPECT_EQ(pipeline.publish_counters().poses_saturated, 0U);
  return result;
}

void expect_tracking_is_true(const ReplayResult& result, const std::string& truth_file) {
  const auto truth = platform::read_tum(truth_file);
  for (const platform::SweepResult& sweep : result.sweeps) {
    const auto there = platform::interpolate(truth, sweep.fix.at.stamp_utc_ns);
    if (!there || sweep.fix.state != ndt::State::tracking) continue;
    EXPECT_LT((sweep.fix.at.pose.translation() - there->translation()).norm(), 0.3)
        << sweep.fix.at.stamp_utc_ns;
  }
}

TEST_F(SimulatedDrive, MissingSweepsArePredicted) {
  const ReplayResult result = replay_with_silence(path(""), 0.3);
  EXPECT_GE(result.tally.missing(), 2U);
  EXPECT_LE(result.tally.missing(), 3U);
  EXPECT_EQ(result.tally.count(ndt::State::no_data), 0U);
  EXPECT_EQ(result.tally.count(ndt::State::lost), 0U);
  for (const platform::SweepResult& sweep : result.sweeps) {
    EXPECT_LE(sweep.fix.at.stamp_utc_ns - sweep.seen_utc_ns, sweep.missing ? 400'000'000 : 0);
    if (sweep.missing) {
      EXPECT_EQ(sweep.fix.state, ndt::State::predicted);
    }
  }
  const auto poses = result.trajectory();
  // The capture ends a packet or two into a turn: the last is too little to be sure of.
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(poses[i].stamp_utc_ns - poses[i - 1].stamp_utc_ns) * 1e-9, 0.1, 0.051);
  }
  EXPECT_EQ(result.sweeps.end()[-2].fix.state, ndt::State::tracking);
  expect_tracking_is_true(result, path("truth.tum"));
  EXPECT_TRUE(!result.heap_calls || *result.heap_calls == 0U);
  const auto late = std::ranges::count_if(result.sweeps, &platform::SweepResult::late);
  EXPECT_EQ(late, 1) << "what was seen of the turn that the gap cuts short";
  const auto frames = platform::read_candump(path("silence0.3.log"));
  EXPECT_TRUE(std::ranges::is_sorted(frames, {}, &platform::StampedFrame::stamp_utc_ns))
      << "no pose goes back";
  const std::string first = test::text_of(path("silence0.3.log"));
  EXPECT_EQ(platform::format_tum(replay_with_silence(path(""), 0.3).trajectory()),
            platform::format_tum(poses));
  EXPECT_EQ(test::text_of(path("silence0.3.log")), first);
}

TEST_F(SimulatedDrive, ASilentSensorIsNoDataAfterASecond) {
  const ReplayResult result = replay_with_silence(path(""), 3.0);
  // Twice a second where a clock goes on; here it is the packets' times that do, and the next comes at the
  // end.
  EXPECT_EQ(result.tally.count(ndt::State::no_data), 1U);
  std::size_t predicted = 0;
  for (const platform::SweepResult& sweep : result.sweeps) {
    const bool is_prediction = sweep.missing && sweep.fix.state == ndt::State::predicted;
    predicted += is_prediction ? 1U : 0U;
    if (is_prediction) {
      EXPECT_LE(sweep.fix.at.stamp_utc_ns - sweep.seen_utc_ns, 1'000'000'000);
    }
  }
  EXPECT_GE(predicted, 9U);
  EXPECT_LE(predicted, 10U);
  expect_tracking_is_true(result, path("truth.tum"));
  EXPECT_TRUE(!result.heap_calls || *result.heap_calls == 0U);
}

TEST_F(SimulatedDrive, ACaptureThatIsCutShortGivesThePosesThatItHolds) {
  const std::string whole = test::text_of(path("capture.pcap"));
  std::ofstream(path("cut.pcap"), std::ios::binary) << whole.substr(0, whole.size() / 3 + 11);
  const Outcome outcome =
      landfix({"replay", "--config", path("config.toml"), "--pcap", path("cut.pcap"), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const nlohmann::json report = nlohmann::json::parse(outcome.out);
  EXPECT_TRUE(report["truncated"]);
  EXPECT_GT(report["poses"], 10);
}

TEST_F(SimulatedDrive, MistakesAreOneLineThatSaysWhatToDo) {
  const auto expect = [](const Outcome& outcome, int code, const std::string& part) {
    EXPECT_EQ(outcome.code, code) << part;
    EXPECT_THAT(outcome.error, HasSubstr(part));
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    EXPECT_EQ(outcome.out, "");
  };
  const std::string config = test::text_of(path("config.toml"));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = config;
    changed.replace(changed.find(from), from.size(), to);
    std::ofstream(path("changed.toml")) << changed;
    return landfix({"replay", "--config", path("changed.toml"), "--pcap", path("capture.pcap")});
  };
  expect(with("port = 2368", "port = 2370"), 1, "on port 2370");
  expect(with("port = 2368", "address = \"10.0.0.1\""), 1, "0 packets to it, 0 rejected");
  expect(with("model = \"vlp16\"", "model = \"vlp61\""), 1, "vlp61");
  expect(with("resolution_m = 1.0", "resolution_m = 2.0"), 1, "they must agree");
  expect(with("leaf_m", "leaf_n"), 1, "leaf_n");
  expect(replay({"--map", path("missing.ndt")}), 1, "missing.ndt");
  expect(replay({"--map", path("map.pcd")}), 1, "not a landfix map");
  expect(replay({"--initial-pose", "1,2,3"}), 2, "--initial-pose");
  expect(replay({"--truth", path("config.toml")}), 1, "config.toml");
  expect(replay({"--trajectory", path("no/such/folder.tum")}), 1, "no/such/folder.tum");
  expect(landfix({"replay", "--config", path("config.toml"), "--pcap", path("map.pcd")}), 1, "map.pcd");
}

}  // namespace
}  // namespace landfix::tools
