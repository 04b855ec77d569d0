// A vehicle that is not where it is taken to be: switched on anywhere, told a wrong place, blinded while it
// drives, or carried away. It says TRACKING of no place but its own, and finds itself.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "ndt/pose.hpp"
#include "platform/candump_log.hpp"
#include "platform/place_search.hpp"
#include "platform/trajectory.hpp"
#include "support/drive_verdict.hpp"
#include "support/packet_list.hpp"
#include "support/run_landfix.hpp"
#include "support/store.hpp"
#include "support/test_data.hpp"
#include "tools/replay_run.hpp"
#include "tools/replay_setup.hpp"

namespace landfix::tools {
namespace {

using ndt::StampedPose;
using test::OwnedPacket;
using test::PacketList;

constexpr std::size_t kPayload = 1206;  // of a VLP-16's data packet
constexpr std::size_t kTimeOffset = 1200;
constexpr std::int64_t kHour_us = 3'600'000'000;

/// A drive, or what was made of one.
struct Tape {
  PacketList packets;
  std::vector<StampedPose> truth;
};

/// 300 m of a route.
class Kidnapping : public testing::TestWithParam<const char*> {
 protected:
  static void TearDownTestSuite() { directory_.reset(); }

  void SetUp() override {
    if (!directory_) directory_ = std::make_unique<test::TemporaryDirectory>();
    if (!std::filesystem::exists(path("map.ndt"))) {
      ASSERT_NO_FATAL_FAILURE(simulate());
    }
    setup_ = std::make_unique<ReplaySetup>(prepare_replay({.config = path("config.toml")}));
    tape_ = {.packets = test::read_packets(path("capture.pcap")),
             .truth = platform::read_tum(path("truth.tum"))};
  }

  [[nodiscard]] static std::string path(const std::string& name) {
    return (directory_->path() / GetParam() / name).string();
  }
  [[nodiscard]] const Tape& tape() const { return tape_; }
  /// Metres from the start to each pose.
  [[nodiscard]] std::size_t pose_after(double way_m, std::size_t from = 0) const {
    std::size_t i = from;
    for (double gone_m = 0.0; gone_m < way_m && i + 1 < tape_.truth.size(); ++i)
      gone_m += (tape_.truth[i + 1].pose.translation() - tape_.truth[i].pose.translation()).norm();
    return i;
  }

  struct Start {
    std::optional<ndt::Pose> pose{};
    std::optional<ndt::PoseGuess> area{};
  };
  using Frames = std::vector<platform::StampedFrame>;
  [[nodiscard]] ReplayResult replay(const PacketList& packets, const Start& start,
                                    const Frames& frames = {}) const {
    test::ListSource source(packets);
    platform::PipelineSettings settings = setup_->settings;
    settings.initial_pose = start.pose;
    settings.initial_area = start.area;
    settings.gnss = {};  // which would tell
    platform::PlaceSearch search(setup_->map());
    search.prepare();
    platform::Pipeline pipeline(settings, setup_->decoder, setup_->map(), nullptr, {.search = &search});
    platform::FrameLog bus(frames);
    return run_replay(
        source, pipeline, [&](const platform::SweepResult&) { pipeline.search(); }, &bus);
  }
  /// What the vehicle's bus says of a drive from which that time was cut.
  [[nodiscard]] static Frames frames_without(std::int64_t from_ns, std::int64_t until_ns) {
    Frames frames;
    for (platform::StampedFrame each : platform::read_candump(path("odometry.log"))) {
      if (each.stamp_utc_ns > from_ns && each.stamp_utc_ns <= until_ns) continue;
      if (each.stamp_utc_ns > until_ns) each.stamp_utc_ns += from_ns - until_ns;
      frames.push_back(each);
    }
    return frames;
  }
  [[nodiscard]] Start right_start() const { return {.pose = setup_->settings.initial_pose}; }

  /// What is TRACKING is true, and it is, this long after the fault.
  static void expect_found(const std::string& name, const Tape& tape, const ReplayResult& result,
                           std::int64_t until_utc_ns, double limit_s) {
    const test::DriveVerdict verdict = test::judge_drive(result.sweeps, tape.truth, until_utc_ns);
    const std::string row = fmt::format(
        "{}, {}: worst {:.2f} m {:.2f} deg while TRACKING, again after {}", GetParam(), name, verdict.worst_m,
        verdict.worst_deg, verdict.recovery_s ? fmt::format("{:.2f} s", *verdict.recovery_s) : "never");
    fmt::print("{}\n", row);
    RecordProperty(name, row);
    EXPECT_LT(verdict.worst_m, 0.3) << name;
    EXPECT_LT(verdict.worst_deg, 1.0) << name;
    EXPECT_TRUE(verdict.ends_tracking) << name;
    ASSERT_TRUE(verdict.recovery_s) << name;
    EXPECT_LE(*verdict.recovery_s, limit_s) << name;
    EXPECT_TRUE(!result.heap_calls || *result.heap_calls == 0U) << name;
  }

 private:
  void simulate() const {
    std::filesystem::create_directory(directory_->path() / GetParam());
    const test::Outcome simulated = test::run_landfix(
        {"simulate", "--route", GetParam(), "--sensor", "vlp16", "--length", "300", "--output", path("")});
    ASSERT_EQ(simulated.code, 0) << simulated.error;
    const test::Outcome mapped = test::run_landfix(
        {"map", "--pcd", path("map.pcd"), "--resolution", "1", "--output", path("map.ndt")});
    ASSERT_EQ(mapped.code, 0) << mapped.error;
  }

  static inline std::unique_ptr<test::TemporaryDirectory> directory_;
  std::unique_ptr<ReplaySetup> setup_;
  Tape tape_;
};

/// Both clocks.
[[nodiscard]] OwnedPacket moved(OwnedPacket packet, std::int64_t by_ns) {
  packet.packet.receive_utc_ns += by_ns;
  if (packet.payload.size() != kPayload) return packet;
  std::byte* const time = packet.payload.data() + kTimeOffset;
  std::int64_t us = 0;
  for (unsigned i = 0; i < 4; ++i) us |= std::to_integer<std::int64_t>(time[i]) << 8 * i;
  test::store(time, static_cast<std::uint32_t>((us + by_ns / 1000 + kHour_us) % kHour_us), 4);
  return packet;
}

/// When the first packet from then on came that ends a sweep.
[[nodiscard]] std::int64_t end_of_sweep(const Tape& tape, std::int64_t from_ns) {
  const auto azimuth = [](const OwnedPacket& packet) {
    return std::to_integer<unsigned>(packet.payload[2]) | std::to_integer<unsigned>(packet.payload[3]) << 8;
  };
  unsigned before = 0;
  for (const OwnedPacket& packet : tape.packets) {
    if (packet.payload.size() != kPayload) continue;
    if (packet.packet.receive_utc_ns >= from_ns && azimuth(packet) < before)
      return packet.packet.receive_utc_ns;
    before = azimuth(packet);
  }
  return from_ns;
}

/// What was driven between two sweeps' ends is cut out: the vehicle is carried on.
[[nodiscard]] Tape without(const Tape& tape, std::int64_t from_ns, std::int64_t until_ns) {
  Tape cut;
  for (const OwnedPacket& packet : tape.packets) {
    const std::int64_t time_ns = packet.packet.receive_utc_ns;
    if (time_ns <= from_ns) cut.packets.push_back(packet);
    if (time_ns > until_ns) cut.packets.push_back(moved(packet, from_ns - until_ns));
  }
  for (const StampedPose& at : tape.truth) {
    if (at.stamp_utc_ns < from_ns) cut.truth.push_back(at);
  }
  // From one place to the other in no time.
  cut.truth.push_back({from_ns, platform::interpolate(tape.truth, from_ns).value()});
  cut.truth.push_back({from_ns + 1, platform::interpolate(tape.truth, until_ns).value()});
  for (const StampedPose& at : tape.truth) {
    if (at.stamp_utc_ns > until_ns + 1) cut.truth.push_back({at.stamp_utc_ns + from_ns - until_ns, at.pose});
  }
  return cut;
}

/// As if switched on there, and not for long.
[[nodiscard]] Tape from(const Tape& tape, std::size_t first) {
  constexpr std::int64_t kFor_ns = 8'000'000'000;
  const std::int64_t from_ns = tape.truth[first].stamp_utc_ns;
  Tape part{.packets = {},
            .truth = {tape.truth.begin() + static_cast<std::ptrdiff_t>(first), tape.truth.end()}};
  for (const OwnedPacket& packet : tape.packets) {
    const std::int64_t time_ns = packet.packet.receive_utc_ns;
    if (time_ns > from_ns && time_ns < from_ns + kFor_ns) part.packets.push_back(packet);
  }
  return part;
}

/// Something stands 4 m away for so long, in the way of what is seen between two azimuths.
[[nodiscard]] Tape behind_a_screen(Tape tape, std::int64_t from_ns, std::int64_t until_ns, unsigned first_deg,
                                   unsigned last_deg) {
  constexpr std::size_t kBlocks = 12;
  constexpr std::size_t kBlock = 100;
  constexpr std::uint32_t kScreen = 4 * 500;  // in units of 2 mm
  for (OwnedPacket& packet : tape.packets) {
    const std::int64_t time_ns = packet.packet.receive_utc_ns;
    if (packet.payload.size() != kPayload || time_ns < from_ns || time_ns >= until_ns) continue;
    for (std::size_t block = 0; block < kBlocks; ++block) {
      std::byte* const bytes = packet.payload.data() + block * kBlock;
      const unsigned azimuth_deg =
          (std::to_integer<unsigned>(bytes[2]) | std::to_integer<unsigned>(bytes[3]) << 8) / 100;
      if (azimuth_deg < first_deg || azimuth_deg >= last_deg) continue;
      for (std::size_t channel = 0; channel < 32; ++channel) {
        std::byte* const distance = bytes + 4 + 3 * channel;
        const unsigned raw = std::to_integer<unsigned>(distance[0]) | std::to_integer<unsigned>(distance[1])
                                                                          << 8;
        if (raw > kScreen) test::store(distance, kScreen, 2);
      }
    }
  }
  return tape;
}

TEST_P(Kidnapping, SwitchedOnAnywhere) {
  for (const double way_m : {0.0, 60.0, 120.0, 180.0, 240.0}) {
    const Tape part = from(tape(), pose_after(way_m));
    const std::int64_t began_ns = part.truth.front().stamp_utc_ns;
    const std::string name = fmt::format("switched on after {} m", way_m);
    expect_found(name + ", knows nothing", part, replay(part.packets, {}), began_ns, 3.0);
    const ndt::PoseGuess area{
        .position_m = part.truth.front().pose.translation().head<2>() + Eigen::Vector2d(-20.0, 15.0),
        .within_m = 40.0};
    expect_found(name + ", knows an area", part, replay(part.packets, {.area = area}), began_ns, 3.0);
  }
}

TEST_P(Kidnapping, ToldTheRightPlaceWhileDriving) {
  for (const double way_m : {60.0, 120.0, 180.0, 240.0}) {
    const Tape part = from(tape(), pose_after(way_m));
    const StampedPose& start = part.truth.front();
    expect_found(fmt::format("told its place while driving, after {} m", way_m), part,
                 replay(part.packets, {.pose = start.pose}), start.stamp_utc_ns, 2.0);
  }
}

TEST_P(Kidnapping, ToldAWrongPlace) {
  const Tape start = from(tape(), 0);
  const std::int64_t began_ns = start.truth.front().stamp_utc_ns;
  for (const double heading_deg : {0.0, 90.0, 180.0, 270.0}) {
    const double heading_rad = heading_deg * ndt::kRadians_per_deg;
    const ndt::Pose wrong =
        *right_start().pose *
        ndt::make_pose({30.0 * std::cos(heading_rad), 30.0 * std::sin(heading_rad), 0.0}, {});
    expect_found(fmt::format("told a place 30 m off, at {} deg", heading_deg), start,
                 replay(start.packets, {.pose = wrong}), began_ns, 3.0);
  }
  for (const double heading_deg : {90.0, 180.0}) {
    const ndt::Pose wrong =
        *right_start().pose * ndt::make_pose({}, {.yaw_rad = heading_deg * ndt::kRadians_per_deg});
    expect_found(fmt::format("told a heading {} deg off", heading_deg), start,
                 replay(start.packets, {.pose = wrong}), began_ns, 3.0);
  }
}

TEST_P(Kidnapping, CarriedAway) {
  for (const double way_m : {40.0, 100.0, 150.0}) {
    const std::size_t first = pose_after(way_m);
    const std::int64_t from_ns = end_of_sweep(tape(), tape().truth[first].stamp_utc_ns);
    const std::int64_t until_ns = end_of_sweep(tape(), tape().truth[pose_after(100.0, first)].stamp_utc_ns);
    const Tape cut = without(tape(), from_ns, until_ns);
    const std::string name = fmt::format("carried on by 100 m after {} m", way_m);
    expect_found(name, cut, replay(cut.packets, right_start()), from_ns + 1, 4.0);
    // An area is where it was at the start, not where it is now.
    const ndt::PoseGuess area{.position_m = right_start().pose->translation().head<2>(), .within_m = 20.0};
    expect_found(name + ", began in an area", cut, replay(cut.packets, {.area = area}), from_ns + 1, 4.0);
    const auto frames = frames_without(from_ns, until_ns);
    expect_found(name + ", with odometry", cut, replay(cut.packets, right_start(), frames), from_ns + 1, 4.0);
  }
}

TEST_P(Kidnapping, Blinded) {
  constexpr std::int64_t kFor_ns = 5'000'000'000;
  for (const double way_m : {60.0, 120.0}) {
    const std::int64_t from_ns = tape().truth[pose_after(way_m)].stamp_utc_ns;
    for (const auto& [first_deg, last_deg] : {std::pair(0U, 360U), {180U, 360U}, {90U, 360U}}) {
      const Tape screened = behind_a_screen(tape(), from_ns, from_ns + kFor_ns, first_deg, last_deg);
      expect_found(fmt::format("blinded from {} to {} deg for 5 s after {} m", first_deg, last_deg, way_m),
                   screened, replay(screened.packets, right_start()), from_ns + kFor_ns, 3.0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Routes, Kidnapping, testing::Values("A", "B", "C"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace landfix::tools
