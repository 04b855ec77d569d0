// `landfix locate` on a street of 40 m, simulated with scans.
#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "platform/trajectory.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"

namespace landfix::tools {
namespace {

class LocateCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryDirectory;
    const auto run = [](const std::vector<std::string>& words) {
      const test::Outcome outcome = test::run_landfix(words);
      ASSERT_EQ(outcome.code, 0) << outcome.error;
    };
    run({"simulate", "--route", "street", "--length", "40", "--sensor", "vlp16", "--scans", "--output",
         path("drive")});
    run({"map", "--pcd", path("drive/map.pcd"), "--resolution", "1", "--output", path("map.ndt")});
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  [[nodiscard]] static std::string path(const std::string& name) { return folder_->path() / name; }

  [[nodiscard]] static test::Outcome locate(const std::vector<std::string>& more) {
    std::vector<std::string> words{"locate", "--map", path("map.ndt")};
    words.insert(words.end(), more.begin(), more.end());
    return test::run_landfix(words);
  }

  static inline test::TemporaryDirectory* folder_ = nullptr;
};

TEST_F(LocateCommand, FindsAScanWithoutAGuess) {
  const ndt::Pose truth = platform::read_tum(path("drive/scans.tum")).at(10).pose;
  const test::Outcome outcome = locate({"--scan", path("drive/scans/0010.pcd"), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_TRUE(json["sure"].get<bool>()) << json["confidence"];
  EXPECT_GT(json["seconds"], 0.0);
  EXPECT_EQ(json["covariance"].size(), 36U);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(json["pose"][static_cast<std::size_t>(axis)], truth.translation()[axis], 0.1);
  ASSERT_GE(json["candidates"].size(), 1U);
  EXPECT_EQ(json["candidates"][0]["pose"], json["pose"]);
  const test::Outcome text = locate({"--scan", path("drive/scans/0010.pcd")});
  EXPECT_NE(text.out.find("verdict           sure"), std::string::npos) << text.out;
}

TEST_F(LocateCommand, LooksInAnAreaOnly) {
  const Eigen::Vector3d place_m = platform::read_tum(path("drive/scans.tum")).at(10).pose.translation();
  const auto area = [&](double aside_m) {
    return std::to_string(place_m.x() + aside_m) + "," + std::to_string(place_m.y()) + ",5";
  };
  const auto at = [&](const std::string& where) {
    const test::Outcome outcome = locate({"--scan", path("drive/scans/0010.pcd"), "--json", "--area", where});
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    return nlohmann::json::parse(outcome.out);
  };
  EXPECT_TRUE(at(area(3.0))["sure"].get<bool>());
  EXPECT_FALSE(at(area(-20.0))["sure"].get<bool>());
  const nlohmann::json beyond = at(area(1e5));
  EXPECT_FALSE(beyond["sure"].get<bool>());
  EXPECT_TRUE(beyond["candidates"].empty());
}

TEST_F(LocateCommand, CountsHowOftenItIsRight) {
  const test::Outcome outcome = locate({"--scans", path("drive/scans"), "--truth", path("drive/scans.tum"),
                                        "--every", "5", "--json", "--table", path("table.csv")});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_GT(json["scans"], 5);
  EXPECT_EQ(json["right"], json["scans"]);
  EXPECT_EQ(json["wrong_and_sure"], 0);
  std::ifstream table(path("table.csv"));
  const auto lines =
      std::count(std::istreambuf_iterator<char>(table), std::istreambuf_iterator<char>(), '\n');
  EXPECT_EQ(lines, json["scans"].get<int>() + 1);
}

TEST_F(LocateCommand, WhatIsNotANumberIsRefused) {
  for (const char* const option : {"--leaf", "--min-range", "--max-range", "--entropy-share"})
    EXPECT_EQ(locate({"--scan", path("drive/scans/0010.pcd"), option, "nan"}).code, 2) << option;
}

TEST_F(LocateCommand, SaysWhatIsMissing) {
  EXPECT_EQ(locate({}).code, 2);
  EXPECT_EQ(locate({"--scans", path("drive/scans")}).code, 2) << "no truth";
  for (const char* const area : {"1,2,0", "1,2,-3", "nan,2,5", "1,inf,5", "1,2,nan", "1,2,1e300"})
    EXPECT_EQ(locate({"--scan", path("drive/scans/0010.pcd"), "--area", area}).code, 2) << area;
  EXPECT_EQ(locate({"--scans", path("drive/scans"), "--truth", path("drive/truth.tum")}).code, 2)
      << "of other times";
  EXPECT_EQ(locate({"--scan", path("drive/nothing.pcd")}).code, 1);
}

}  // namespace
}  // namespace landfix::tools
