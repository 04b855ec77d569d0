// A vehicle that is switched on anywhere along a drive, with nothing but a satellite receiver to say where.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "platform/candump_log.hpp"
#include "platform/trajectory.hpp"
#include "support/interrupted_source.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"
#include "tools/replay_run.hpp"
#include "tools/replay_setup.hpp"

namespace landfix::tools {
namespace {

using Frames = std::vector<platform::StampedFrame>;

constexpr std::uint32_t kPositionId = 0x1B0;
constexpr std::uint32_t kHeadingId = 0x1B1;

/// 150 m each of a flat street and of a hilly road.
class GnssDrive : public testing::TestWithParam<const char*> {
 protected:
  static void TearDownTestSuite() { directory_.reset(); }

  void SetUp() override {
    if (!directory_) directory_ = std::make_unique<test::TemporaryDirectory>();
    if (!std::filesystem::exists(path("map.ndt"))) simulate();
    truth_ = platform::read_tum(path("truth.tum"));
    bus_ = platform::read_candump(path("odometry.log"));
  }

  [[nodiscard]] static std::string path(const std::string& name) {
    return (directory_->path() / GetParam() / name).string();
  }

  struct Run {
    double found_after_s = std::nan("");  ///< from the first sweep to the first that is TRACKING
    double worst_m = 0.0;                 ///< of these
    std::size_t tracking = 0;
  };
  /// As if the LiDAR had been switched on at that time.
  [[nodiscard]] static Run replay(const Frames& bus, double from_s) {
    constexpr double kOn_s = 5.0;
    const ReplaySetup setup = prepare_replay({.config = path("config.toml")});
    platform::Pipeline pipeline(setup.settings, setup.decoder, setup.map(), nullptr);
    test::InterruptedSource source(path("capture.pcap"), 0.0, from_s);
    platform::FrameLog log(bus);
    std::int64_t first_utc_ns = 0;
    Run run;
    (void)run_replay(
        source, pipeline,
        [&](const platform::SweepResult& sweep) {
          const std::int64_t stamp_utc_ns = sweep.fix.at.stamp_utc_ns;
          if (first_utc_ns == 0) first_utc_ns = stamp_utc_ns;
          const double since_s = static_cast<double>(stamp_utc_ns - first_utc_ns) * 1e-9;
          if (sweep.fix.state != ndt::State::tracking || since_s > kOn_s) return;
          if (run.tracking++ == 0) run.found_after_s = since_s;
          const auto there = platform::interpolate(truth_, stamp_utc_ns);
          if (there)
            run.worst_m =
                std::max(run.worst_m, (sweep.fix.at.pose.translation() - there->translation()).norm());
        },
        &log);
    return run;
  }

  static void expect_found(const Frames& bus, double from_s, double limit_s) {
    const Run run = replay(bus, from_s);
    fmt::print("{}, {:.1f} s: found after {:.2f} s, within {:.3f} m\n", GetParam(), from_s, run.found_after_s,
               run.worst_m);
    EXPECT_LT(run.found_after_s, limit_s) << from_s;
    EXPECT_LT(run.worst_m, 0.3) << from_s;
  }

  /// The frames of all other identifiers.
  [[nodiscard]] static Frames without(std::uint32_t id) {
    Frames rest;
    for (const platform::StampedFrame& each : bus_) {
      if (each.frame.id != id) rest.push_back(each);
    }
    return rest;
  }
  /// With a receiver that is so far off to the north.
  [[nodiscard]] static Frames with_error_m(double error_m) {
    constexpr double kSteps_per_m = 1e7 / 111'200.0;
    Frames changed = bus_;
    for (platform::StampedFrame& each : changed) {
      if (each.frame.id != kPositionId) continue;
      std::uint32_t raw = 0;
      for (std::size_t i = 4; i-- > 0;) raw = raw << 8 | std::to_integer<std::uint32_t>(each.frame.data[i]);
      raw += static_cast<std::uint32_t>(std::lround(error_m * kSteps_per_m));
      for (std::size_t i = 0; i < 4; ++i) each.frame.data[i] = static_cast<std::byte>(raw >> 8 * i & 0xFFU);
    }
    return changed;
  }

  static inline std::vector<ndt::StampedPose> truth_;
  static inline Frames bus_;

 private:
  static void simulate() {
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"simulate", "--route", GetParam(), "--length", "150", "--sensor", "vlp16", "--output",
              path("")},
             {"map", "--pcd", path("map.pcd"), "--resolution", "1", "--output", path("map.ndt")}}) {
      const test::Outcome outcome = test::run_landfix(words);
      ASSERT_EQ(outcome.code, 0) << outcome.error;
    }
    // No pose: the line goes.
    std::ifstream in(path("config.toml"));
    std::string config;
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with("pose = ")) config += line + '\n';
    }
    std::ofstream(path("config.toml")) << config;
  }

  static inline std::unique_ptr<test::TemporaryDirectory> directory_;
};
INSTANTIATE_TEST_SUITE_P(Routes, GnssDrive, testing::Values("street", "C"));

TEST_P(GnssDrive, IsFoundWhereverItIsSwitchedOn) {
  for (const double from_s : {0.5, 4.0, 7.5, 11.0, 14.0}) expect_found(bus_, from_s, 2.0);
}

TEST_P(GnssDrive, IsFoundWithoutAHeading) {
  const Frames no_heading = without(kHeadingId);
  for (const double from_s : {0.5, 7.5, 14.0}) expect_found(no_heading, from_s, 4.0);
}

TEST_P(GnssDrive, AReceiverThatIsWrongLeadsNowhereOrToTheTruth) {
  for (const double error_m : {10.0, -30.0, 1000.0}) {
    const Run run = replay(with_error_m(error_m), 7.5);
    fmt::print("{}, {} m off: {} sweeps TRACKING, within {:.3f} m\n", GetParam(), error_m, run.tracking,
               run.worst_m);
    EXPECT_LT(run.worst_m, 0.3) << error_m;
  }
}

TEST_P(GnssDrive, WithoutAnythingItWaits) {
  Frames nothing = without(kPositionId);
  EXPECT_EQ(replay(nothing, 0.5).tracking, 0U);
}

TEST_P(GnssDrive, TheProgramSaysSo) {
  const test::Outcome outcome =
      test::run_landfix({"replay", "--config", path("config.toml"), "--odometry", path("odometry.log"),
                         "--pcap", path("capture.pcap"), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const auto report = nlohmann::json::parse(outcome.out);
  EXPECT_GT(report["gnss"]["frames"], 50);
  EXPECT_GT(report["gnss"]["guesses"], 3);
  const test::Outcome blind = test::run_landfix(
      {"replay", "--config", path("config.toml"), "--pcap", path("capture.pcap"), "--map", path("map.ndt")});
  EXPECT_EQ(blind.code, 0) << blind.error << "the map itself is searched";
}

}  // namespace
}  // namespace landfix::tools
