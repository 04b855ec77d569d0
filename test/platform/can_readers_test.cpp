// Independent readers of our logs and our DBC: python-can and can-utils (Debian's python3-can, can-utils) and
// npm candied (`npm ci` in can_readers/). Skipped, saying so, where they are absent.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "platform/candump_log.hpp"
#include "platform/pose_frames.hpp"
#include "support/random_pose_report.hpp"
#include "support/send_frame.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kSweep_ns = 50'123'000;
const std::string kPython = "/usr/bin/python3";  // Debian's, which has Debian's python3-can
const std::string kReaders = LANDFIX_CAN_READERS;

/// What a command prints on stdout; what it says on stderr as well.
std::string output_of(const std::string& command) {
  std::string output;
  std::FILE* const pipe = ::popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer;
  while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    output.append(buffer.data(), size);
  }
  ::pclose(pipe);
  return output;
}

bool runs(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }

class CanReaders : public testing::TestWithParam<bool> {
 protected:
  /// A log of 100 random poses.
  CanReaders() {
    std::mt19937_64 random(1);
    PoseFrameEncoder encoder(0x3A0, fd_, true);
    CandumpLog log(log_, "can0");
    for (int i = 0; i < 100; ++i) {
      PoseReport report = test::random_report(random, pose_layouts(fd_));
      report.latitude_deg = std::uniform_real_distribution<double>(-90.0, 90.0)(random);
      report.longitude_deg = std::uniform_real_distribution<double>(-179.0, 179.0)(random);
      report.map_hash = static_cast<std::uint16_t>(random());
      report.stamp_utc_ns = kStart_ns + i * kSweep_ns;
      const PoseFrames sent = encoder.encode(report);
      for (const CanFrame& frame : sent.all()) {
        EXPECT_TRUE(test::send_frame(log, frame, report.stamp_utc_ns));
        frames_.push_back(frame);
        stamps_utc_ns_.push_back(report.stamp_utc_ns);
      }
      reports_.insert(reports_.end(), sent.count, report);
    }
    log.commit();
  }

  /// As read_log.py prints the frames; `start_ns`: what their stamps count from.
  std::string expected_frames(std::int64_t start_ns) const {
    std::string text;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      std::string data;
      for (const std::byte byte : frames_[i].payload()) {
        data += fmt::format("{:02X}", std::to_integer<unsigned>(byte));
      }
      const std::int64_t stamp_us = (stamps_utc_ns_[i] - start_ns) / 1000;
      text += fmt::format("{}.{:06} {:X} {:d} {:d} {}\n", stamp_us / 1'000'000, stamp_us % 1'000'000,
                          frames_[i].id, frames_[i].fd, frames_[i].bit_rate_switch, data);
    }
    return text;
  }

  bool fd_ = GetParam();
  test::TemporaryDirectory directory_;
  std::filesystem::path log_ = directory_.path() / "can.log";
  std::vector<CanFrame> frames_;
  std::vector<std::int64_t> stamps_utc_ns_;
  std::vector<PoseReport> reports_;
};
INSTANTIATE_TEST_SUITE_P(, CanReaders, testing::Bool(),
                         [](const auto& fd) { return fd.param ? "Fd" : "Classic"; });

TEST_P(CanReaders, PythonCanReadsTheLog) {
  if (!runs(kPython + " -c 'import can'")) GTEST_SKIP() << "no python-can: apt-get install python3-can";
  EXPECT_EQ(output_of(fmt::format("{} {}/read_log.py {}", kPython, kReaders, log_.string())),
            expected_frames(0));
}

TEST_P(CanReaders, Log2ascTurnsTheLogIntoVectorsFormat) {
  if (!runs("command -v log2asc")) GTEST_SKIP() << "no log2asc: apt-get install can-utils";
  if (!runs(kPython + " -c 'import can'")) GTEST_SKIP() << "no python-can: apt-get install python3-can";
  const std::string asc = (directory_.path() / "can.asc").string();
  ASSERT_TRUE(runs(fmt::format("log2asc -I {} -O {} can0", log_.string(), asc)));
  EXPECT_EQ(output_of(fmt::format("{} {}/read_log.py {}", kPython, kReaders, asc)),
            expected_frames(kStart_ns));
}

TEST_P(CanReaders, CandiedReadsEverySignalThroughTheDbc) {
  if (!std::filesystem::exists(kReaders + "/node_modules/candied") || !runs("command -v node")) {
    GTEST_SKIP() << "no npm candied: npm ci in test/platform/can_readers";
  }
  std::istringstream lines(output_of(
      fmt::format("node {}/decode.cjs {}/landfix.dbc {}", kReaders, LANDFIX_CONFIG_FOLDER, log_.string())));
  std::size_t frame = 0;
  std::string frame_name;
  std::string signal_name;
  std::string value;
  while (lines >> frame_name >> signal_name >> value) {
    ASSERT_LT(frame, frames_.size());
    const auto* const layout =
        std::find_if(kFrameLayouts.begin(), kFrameLayouts.end(),
                     [&](const FrameLayout& l) { return frames_[frame].id == 0x3A0U + l.id_offset; });
    ASSERT_EQ(frame_name, layout->name) << signal_name << ' ' << value;
    const auto signal = std::find_if(layout->signals.begin(), layout->signals.end(),
                                     [&](const Signal& s) { return s.name == signal_name; });
    if (signal == layout->signals.end()) continue;  // of the protection
    const double read = std::stod(value);
    const PoseReport& report = reports_[frame];
    if (const auto* number = std::get_if<double PoseReport::*>(&signal->field)) {
      EXPECT_NEAR(read, report.**number, 0.5001 * signal->scale) << signal_name;
    } else if (const auto* time = std::get_if<std::int64_t PoseReport::*>(&signal->field)) {
      // A double holds today's seconds to 0.2 us.
      EXPECT_NEAR(read, static_cast<double>(report.**time) * 1e-9, 0.5001 * signal->scale + 3e-7);
    } else {
      EXPECT_EQ(read, report.**std::get_if<std::uint16_t PoseReport::*>(&signal->field)) << signal_name;
    }
    if (&*signal == &layout->signals.back()) ++frame;
  }
  EXPECT_EQ(frame, frames_.size());
}

}  // namespace
}  // namespace landfix::platform
