#include <algorithm>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "platform/candump_log.hpp"
#include "platform/frame_description.hpp"
#include "platform/pose_frames.hpp"
#include "support/run_landfix.hpp"
#include "support/send_frame.hpp"
#include "support/test_data.hpp"

namespace landfix::tools {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

class CanCommand : public testing::Test {
 protected:
  /// The lines of a log of so many poses, 100 ms apart.
  static std::vector<std::string> lines_of(int poses, bool fd = false) {
    const test::TemporaryDirectory directory;
    const auto path = directory.path() / "can.log";
    platform::CandumpLog log(path, "can0");
    platform::PoseFrameEncoder encoder(0x3A0, fd);
    for (int i = 0; i < poses; ++i) {
      platform::PoseReport report;
      report.stamp_utc_ns = kStart_ns + i * std::int64_t{100'000'000};
      report.x_m = i;
      report.y_m = -1.5;
      report.yaw_rad = 0.5;
      report.state = 5;
      for (const platform::PoseFrames frames = encoder.encode(report);
           const platform::CanFrame& frame : frames.all()) {
        EXPECT_TRUE(test::send_frame(log, frame, report.stamp_utc_ns));
      }
    }
    log.commit();
    std::vector<std::string> lines;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  }

  test::Outcome decode(const std::vector<std::string>& lines, const std::vector<std::string>& more = {}) {
    std::ofstream file(log_);
    for (const std::string& line : lines) file << line << '\n';
    file.close();
    std::vector<std::string> words{"can", "decode", log_};
    words.insert(words.end(), more.begin(), more.end());
    return test::run_landfix(words);
  }

  nlohmann::json json_of(const std::vector<std::string>& lines) {
    const test::Outcome outcome = decode(lines, {"--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    return nlohmann::json::parse(outcome.out);
  }

  test::TemporaryDirectory directory_;
  std::filesystem::path log_ = directory_.path() / "can.log";
};

TEST_F(CanCommand, PrintsThePosesOfALog) {
  for (const bool fd : {false, true}) {
    const test::Outcome outcome = decode(lines_of(3, fd));
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_THAT(outcome.out, testing::ContainsRegex("1700000000.200000000 +2.000 +-1.500 +- .*TRACKING"));
    EXPECT_THAT(outcome.out, HasSubstr("3 poses in"));
    EXPECT_THAT(outcome.out, HasSubstr("faults: none"));
  }
}

TEST_F(CanCommand, PrintsOneJsonObject) {
  const auto object = json_of(lines_of(3));
  EXPECT_EQ(object.at("frames").at("total"), 19);
  EXPECT_EQ(object.at("frames").at("decoded"), 19);
  ASSERT_EQ(object.at("poses").size(), 3U);
  const auto& pose = object.at("poses")[1];
  EXPECT_EQ(pose.at("stamp_utc_ns"), kStart_ns + 100'000'000);
  EXPECT_NEAR(pose.at("x_m").get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(pose.at("yaw_deg").get<double>(), 28.648, 1e-3);
  EXPECT_TRUE(pose.at("sigma_along_m").is_null());
  EXPECT_EQ(pose.at("state"), "TRACKING");
  EXPECT_TRUE(object.at("faults").empty());
}

// The first pose is lines 0 to 5, line 6 names the map, the next poses are 7 to 12, 13 to 18 and so on.
TEST_F(CanCommand, ReportsAndCountsEveryViolation) {
  struct Case {
    std::function<void(std::vector<std::string>&)> damage;
    std::vector<std::string> kinds;
    std::size_t poses;
  };
  const std::vector<Case> cases{
      {[](auto& lines) { lines[8].back() = lines[8].back() == '0' ? '1' : '0'; },
       {"wrong_crc", "incomplete_pose", "lost"},
       4},
      {[](auto& lines) { lines.insert(lines.begin() + 9, lines[8]); }, {"repeated"}, 5},
      {[](auto& lines) { lines.erase(lines.begin() + 7, lines.begin() + 13); },
       {"lost", "lost", "lost", "lost", "lost", "lost"},
       4},
      {[](auto& lines) { std::swap(lines[8], lines[9]); }, {"out_of_order"}, 5},
      {[](auto& lines) { std::swap(lines[8], lines[14]); },
       {"lost", "wrong_sequence", "lost", "incomplete_pose", "incomplete_pose", "incomplete_pose",
        "incomplete_pose"},
       3},
      {[](auto& lines) { lines.pop_back(); }, {"incomplete_pose"}, 4},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    std::vector<std::string> lines = lines_of(5);
    cases[i].damage(lines);
    const auto object = json_of(lines);
    std::vector<std::string> kinds;
    for (const auto& fault : object.at("faults")) kinds.push_back(fault.at("kind"));
    EXPECT_THAT(kinds, testing::UnorderedElementsAreArray(cases[i].kinds)) << "case " << i;
    EXPECT_EQ(object.at("poses").size(), cases[i].poses) << "case " << i;
    for (const std::string& kind : cases[i].kinds) {
      EXPECT_EQ(object.at("fault_counts").at(kind), std::count(kinds.begin(), kinds.end(), kind));
    }
  }
}

TEST_F(CanCommand, SaysInTextWhatIsWrongAndWhere) {
  std::vector<std::string> lines = lines_of(3);
  lines.insert(lines.begin() + 9, lines[8]);
  const test::Outcome outcome = decode(lines);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("! received at 1700000000.100000000: LOC_ATTITUDE: repeated: "));
  EXPECT_THAT(outcome.out, HasSubstr("faults: 1 x repeated"));
}

TEST_F(CanCommand, ReadsOneInterfaceOfSeveral) {
  std::vector<std::string> both;
  for (const std::string& line : lines_of(2)) {
    both.push_back(line);
    both.push_back(line);
    both.back().replace(both.back().find("can0"), 4, "can1");
  }
  const test::Outcome outcome = decode(both);
  EXPECT_THAT(outcome.out, HasSubstr("2 poses in 13 frames of 26; faults: none"));
  EXPECT_THAT(outcome.error, HasSubstr("13 pose frames on other interfaces were left out"));
  EXPECT_THAT(decode(both, {"--interface", "can1"}).out, HasSubstr("2 poses"));
  EXPECT_EQ(decode(both, {"--interface", "can2"}).code, 1);
}

TEST_F(CanCommand, SkipsWhatIsNoFrameOfALog) {
  std::vector<std::string> lines = lines_of(1);
  lines.insert(lines.begin(), {"", "(1.0) can0 123#R", std::string(5000, 'x'), "(1.0) can0 123#00"});
  const test::Outcome outcome = decode(lines);
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_THAT(outcome.out, HasSubstr("1 poses in 7 frames of 8; faults: none"));
}

TEST_F(CanCommand, RefusesWhatItCannotUse) {
  EXPECT_EQ(test::run_landfix({"can"}).code, 2);
  EXPECT_EQ(test::run_landfix({"can", "decode"}).code, 2);
  const test::Outcome missing = test::run_landfix({"can", "decode", (directory_.path() / "none").string()});
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.error, HasSubstr("cannot be read as a log"));
  const test::Outcome other_id = decode(lines_of(1), {"--base-id", "0x500"});
  EXPECT_EQ(other_id.code, 1);
  EXPECT_THAT(other_id.error, HasSubstr("no pose at base id 0x500 among 7 frames"));
  EXPECT_EQ(other_id.out, "");
  EXPECT_EQ(decode(lines_of(1), {"--base-id", "0x7F7"}).code, 2);
  EXPECT_EQ(decode({}).code, 1);
  EXPECT_EQ(test::run_landfix({"can", "decode", directory_.path().string()}).code, 1);
}

TEST_F(CanCommand, PrintsTheDbcAndTheTable) {
  EXPECT_EQ(test::run_landfix({"can", "dbc"}).out, platform::to_dbc(0x3A0));
  EXPECT_EQ(test::run_landfix({"can", "dbc", "--base-id", "0x200"}).out, platform::to_dbc(0x200));
  EXPECT_EQ(test::run_landfix({"can", "table"}).out, platform::to_markdown());
}

}  // namespace
}  // namespace landfix::tools
