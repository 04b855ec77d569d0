// Wheel odometry in a drive whose truth is exact: what it is worth while the LiDAR is silent, and that a
// wrong one does no harm.
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "platform/candump_log.hpp"
#include "platform/evaluation.hpp"
#include "platform/trajectory.hpp"
#include "support/interrupted_source.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"
#include "tools/replay_run.hpp"
#include "tools/replay_setup.hpp"

namespace landfix::tools {
namespace {

using Frames = std::vector<platform::StampedFrame>;

constexpr double kSilence_s = 1.0;

/// 120 m of the street, with its first curve.
class OdometryDrive : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = std::make_unique<test::TemporaryDirectory>();
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"simulate", "--route", "street", "--length", "120", "--sensor", "vlp16", "--output", path("")},
             {"map", "--pcd", path("map.pcd"), "--resolution", "1", "--output", path("map.ndt")}}) {
      const test::Outcome outcome = test::run_landfix(words);
      ASSERT_EQ(outcome.code, 0) << outcome.error;
    }
    truth_ = platform::read_tum(path("truth.tum"));
    odometry_ = platform::read_candump(path("odometry.log"));
  }
  static void TearDownTestSuite() { directory_.reset(); }

  [[nodiscard]] static std::string path(const std::string& name) {
    return (directory_->path() / name).string();
  }

  struct Run {
    ReplayResult result;
    platform::OdometryCounters counters;
    bool speed_believed = false;
    bool yaw_rate_believed = false;
  };
  /// With a silence of the LiDAR from then on.
  [[nodiscard]] static Run replay(const Frames& odometry, double silent_from_s,
                                  double silent_for_s = kSilence_s) {
    const ReplaySetup setup = prepare_replay({.config = path("config.toml")});
    platform::Pipeline pipeline(setup.settings, setup.decoder, setup.map(), nullptr);
    test::InterruptedSource source(path("capture.pcap"), silent_from_s, silent_for_s);
    Run run;
    platform::FrameLog log(odometry);
    run.result = run_replay(
        source, pipeline, [](const platform::SweepResult&) {}, &log);
    run.counters = pipeline.odometry().counters();
    run.speed_believed = pipeline.odometry().speed().is_believed();
    run.yaw_rate_believed = pipeline.odometry().yaw_rate().is_believed();
    return run;
  }

  [[nodiscard]] static double error_m(const platform::SweepResult& sweep) {
    const auto there = platform::interpolate(truth_, sweep.fix.at.stamp_utc_ns);
    return there ? (sweep.fix.at.pose.translation() - there->translation()).norm() : std::nan("");
  }
  /// Of the last pose that was predicted in the silence.
  [[nodiscard]] static double error_at_end_m(const Run& run) {
    double error = std::nan("");
    for (const platform::SweepResult& sweep : run.result.sweeps) {
      if (sweep.missing && sweep.fix.state == ndt::State::predicted) error = error_m(sweep);
    }
    return error;
  }
  static void expect_tracking_is_true(const Run& run) {
    for (const platform::SweepResult& sweep : run.result.sweeps) {
      if (sweep.fix.state == ndt::State::tracking && !std::isnan(error_m(sweep))) {
        EXPECT_LT(error_m(sweep), 0.3) << sweep.fix.at.stamp_utc_ns;
      }
    }
  }

  /// Seconds from the start of the drive to where the curve begins: where the yaw rate grows fastest.
  [[nodiscard]] static double start_of_curve_s() {
    constexpr std::int64_t kHalf_ns = 500'000'000;
    const auto yaw_rad = [](std::int64_t stamp_utc_ns) {
      const auto pose = platform::interpolate(truth_, stamp_utc_ns);
      return pose ? ndt::to_roll_pitch_yaw(pose->linear()).yaw_rad : std::nan("");
    };
    double best = 0.0;
    double best_s = 0.0;
    for (double t_s = 3.0; t_s < 15.0; t_s += 0.1) {
      const std::int64_t at = truth_.front().stamp_utc_ns + static_cast<std::int64_t>(t_s * 1e9);
      const double change =
          std::abs(yaw_rad(at + 2 * kHalf_ns) - 2.0 * yaw_rad(at) + yaw_rad(at - 2 * kHalf_ns));
      if (change > best) {
        best = change;
        best_s = t_s;
      }
    }
    return best_s;
  }

  /// The frames with another speed: raw steps of 0.01 km/h; below 0: no frame.
  [[nodiscard]] static Frames with_speed(const std::function<int(int raw, double time_s)>& says) {
    constexpr std::uint32_t kSpeedId = 0x1A0;
    Frames changed;
    for (platform::StampedFrame each : odometry_) {
      if (each.frame.id == kSpeedId) {
        const int raw =
            std::to_integer<int>(each.frame.data[0]) + 256 * std::to_integer<int>(each.frame.data[1]);
        const int now =
            says(raw, static_cast<double>(each.stamp_utc_ns - truth_.front().stamp_utc_ns) * 1e-9);
        if (now < 0) continue;
        each.frame.data[0] = static_cast<std::byte>(now & 0xFF);
        each.frame.data[1] = static_cast<std::byte>(now >> 8);
      }
      changed.push_back(each);
    }
    return changed;
  }

  static inline std::vector<ndt::StampedPose> truth_;
  static inline Frames odometry_;

 private:
  static inline std::unique_ptr<test::TemporaryDirectory> directory_;
};

TEST_F(OdometryDrive, HalvesTheErrorOfASecondWithoutTheLidarInACurve) {
  double worst_with_m = 0.0;
  double worst_without_m = 0.0;
  for (const double later_s : {-0.75, -0.5, -0.25, 0.0}) {
    const double from_s = start_of_curve_s() + later_s;
    const Run without = replay({}, from_s);
    const Run with = replay(odometry_, from_s);
    fmt::print("silent from {:.2f} s: error at the end {:.3f} m without, {:.3f} m with odometry\n", from_s,
               error_at_end_m(without), error_at_end_m(with));
    worst_without_m = std::max(worst_without_m, error_at_end_m(without));
    worst_with_m = std::max(worst_with_m, error_at_end_m(with));
    EXPECT_TRUE(with.speed_believed && with.yaw_rate_believed);
    // The capture ends a packet or two into a turn: the last is too little to be sure of.
    EXPECT_EQ(with.result.sweeps.end()[-2].fix.state, ndt::State::tracking);
    EXPECT_TRUE(!with.result.heap_calls || *with.result.heap_calls == 0U);
    expect_tracking_is_true(with);
    expect_tracking_is_true(without);
  }
  RecordProperty("error_without_odometry_m", fmt::format("{:.3f}", worst_without_m));
  RecordProperty("error_with_odometry_m", fmt::format("{:.3f}", worst_with_m));
  EXPECT_LE(worst_with_m, 0.5 * worst_without_m);
}

TEST_F(OdometryDrive, ItsUncertaintyIsSmallerAndHoldsTheError) {
  const double from_s = start_of_curve_s() - 0.5;
  const auto sigma_m = [](const Run& run) {
    double sigma = 0.0;
    for (const platform::SweepResult& sweep : run.result.sweeps) {
      if (sweep.missing) sigma = std::sqrt(sweep.fix.covariance(0, 0));
    }
    return sigma;
  };
  const Run without = replay({}, from_s);
  const Run with = replay(odometry_, from_s);
  fmt::print("sigma at the end {:.3f} m without, {:.3f} m with odometry\n", sigma_m(without), sigma_m(with));
  EXPECT_LT(sigma_m(with), 0.5 * sigma_m(without));
  EXPECT_LT(error_at_end_m(with), 3.0 * std::sqrt(2.0) * sigma_m(with));
  EXPECT_LT(error_at_end_m(without), 3.0 * std::sqrt(2.0) * sigma_m(without));
}

TEST_F(OdometryDrive, WhatIsWrongIsLeftOut) {
  const double from_s = start_of_curve_s() - 0.5;
  const double without_m = error_at_end_m(replay({}, from_s));
  const auto expect_no_harm = [&](const Frames& frames, const char* what) {
    const Run run = replay(frames, from_s);
    fmt::print("{}: error at the end {:.3f} m ({:.3f} m without odometry)\n", what, error_at_end_m(run),
               without_m);
    EXPECT_LE(error_at_end_m(run), without_m + 0.2) << what;
    EXPECT_EQ(run.result.tally.count(ndt::State::lost), 0U) << what;
    expect_tracking_is_true(run);
    return run;
  };
  const Run twice =
      expect_no_harm(with_speed([](int raw, double) { return std::min(2 * raw, 65534); }), "twice");
  EXPECT_FALSE(twice.speed_believed);
  const Run stuck = expect_no_harm(
      with_speed([&](int raw, double t_s) { return t_s < from_s - 2.0 ? raw : 300; }), "stuck");
  EXPECT_FALSE(stuck.speed_believed);
  EXPECT_GE(stuck.counters.times_left_out, 1U);
  const Run silent =
      expect_no_harm(with_speed([&](int raw, double t_s) { return t_s < from_s ? raw : -1; }), "silent");
  EXPECT_GT(silent.counters.silent, 5U);
  int count = 0;
  const Run jumps = expect_no_harm(
      with_speed([&](int raw, double) { return ++count % 10 == 0 ? raw + 5000 : raw; }), "jumps");
  EXPECT_GT(jumps.counters.jumps, 50U);
  EXPECT_TRUE(jumps.speed_believed);
}

TEST_F(OdometryDrive, TheCommandReadsTheLogAndSaysWhatItWasWorth) {
  const test::Outcome outcome =
      test::run_landfix({"replay", "--config", path("config.toml"), "--odometry", path("odometry.log"),
                         "--truth", path("truth.tum"), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const nlohmann::json report = nlohmann::json::parse(outcome.out);
  EXPECT_GT(report["odometry"]["samples"], 1000);
  EXPECT_EQ(report["odometry"]["jumps"], 0);
  EXPECT_EQ(report["odometry"]["times_left_out"], 0);
  EXPECT_TRUE(report["odometry"]["speed_believed"]);
  EXPECT_LE(report["evaluation"]["ate_m"]["rmse"], 0.05);
  const test::Outcome refused =
      test::run_landfix({"replay", "--config", path("config.toml"), "--odometry", path("truth.tum")});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.error, testing::HasSubstr("truth.tum: no CAN frame in it"));
}

}  // namespace
}  // namespace landfix::tools
