#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/run_landfix.hpp"
#include "support/test_data.hpp"
#include "support/xml.hpp"

namespace landfix::tools {
namespace {

/// A short study, done once for all tests: one route, two sensors, 100 m.
class StudyCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryDirectory();
    const test::Outcome outcome = study({"--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    json_ = nlohmann::json::parse(outcome.out);
  }
  static void TearDownTestSuite() { delete folder_; }

  [[nodiscard]] static std::filesystem::path folder() { return folder_->path() / "study"; }
  [[nodiscard]] static test::Outcome study(const std::vector<std::string>& more) {
    std::vector<std::string> words{"study",     "--output",     folder().string(), "--routes", "A",
                                   "--sensors", "vlp16,hdl32e", "--length",        "100"};
    words.insert(words.end(), more.begin(), more.end());
    return test::run_landfix(words);
  }
  [[nodiscard]] static std::size_t lines_of(const std::string& name) {
    const std::string text = test::text_of((folder() / name).string());
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
  }

  static inline test::TemporaryDirectory* folder_ = nullptr;
  static inline nlohmann::json json_;  ///< what the study said
};

TEST_F(StudyCommand, LocalizesAndMapsWithEachSensor) {
  ASSERT_EQ(json_["runs"].size(), 2U);
  EXPECT_EQ(json_["failed"], 0);
  for (const auto& run : json_["runs"]) {
    SCOPED_TRACE(run["sensor"]);
    const auto& figures = run["figures"];
    EXPECT_NEAR(figures["length_m"], 100.0, 0.5);
    const auto& found = figures["localization"];
    EXPECT_GT(found["sweeps"], 100);
    EXPECT_EQ(found["lost"], 0);
    EXPECT_LT(found["position_rmse_m"], 0.05);
    EXPECT_LT(found["heading_rmse_deg"], 0.1);
    EXPECT_GT(found["iterations"]["mean"], 1.0);
    for (const char* const settings : {"by_landfix", "by_study"}) {
      const auto& mapping = figures[settings];
      EXPECT_GT(mapping["added"], 20) << settings;
      EXPECT_GT(mapping["mean_plane_variance_m"], 0.0) << settings;
      EXPECT_TRUE(mapping["mean_map_entropy"].is_number()) << settings;
    }
    // By the study's settings a VLP-16 is lost here.
    EXPECT_LT(figures["by_landfix"]["position_rmse_m"], 0.3);
    EXPECT_LT(figures["by_landfix"]["elevation_max_m"], 0.3);
    EXPECT_EQ(figures["variations"].size(), 10U);
  }
}

TEST_F(StudyCommand, LeavesAPageTablesAndPicturesButNoCapture) {
  const std::string page = test::text_of((folder() / "index.html").string());
  EXPECT_TRUE(test::is_well_formed(page.substr(page.find("<html"))));
  EXPECT_THAT(page, testing::HasSubstr("0.294893"));
  EXPECT_EQ(lines_of("mapping.csv"), 1U + 4U);
  EXPECT_EQ(lines_of("localization.csv"), 1U + 2U);
  EXPECT_EQ(lines_of("variations.csv"), 1U + 20U);
  EXPECT_GT(lines_of("along.csv"), 600U);
  for (const std::string sensor : {"vlp16", "hdl32e"}) {
    const std::filesystem::path run = folder() / ("A-" + sensor);
    for (const char* const picture : {"scan.svg", "filtered.svg"}) {
      EXPECT_THAT(page, testing::HasSubstr("A-" + sensor + "/" + picture));
      EXPECT_TRUE(test::is_well_formed(test::text_of((run / picture).string()))) << picture;
    }
    EXPECT_TRUE(std::filesystem::exists(run / "mapping" / "trajectory.tum"));
    EXPECT_FALSE(std::filesystem::exists(run / "capture.pcap"));
    EXPECT_FALSE(std::filesystem::exists(run / "mapping" / "map.pcd"));
  }
}

TEST_F(StudyCommand, DoesNotDoAgainWhatIsDone) {
  const auto result = folder() / "A-vlp16" / "result.json";
  const auto made = std::filesystem::last_write_time(result);
  const test::Outcome outcome = study({});
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_THAT(outcome.out, testing::HasSubstr("before"));
  EXPECT_EQ(std::filesystem::last_write_time(result), made);
}

TEST_F(StudyCommand, FindsSettingsThatAReplayTakes) {
  const auto tuned = folder_->path() / "tuned";
  const test::Outcome outcome =
      test::run_landfix({"study", "--output", tuned.string(), "--routes", "street", "--sensors", "vlp16",
                         "--length", "40", "--ablations", "none", "--tune", "--keep", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["runs"][0]["figures"]["variations"].size(), 24U);
  const auto drive = tuned / "street-vlp16";
  const test::Outcome replay = test::run_landfix({"replay", "--config", (drive / "tuned.toml").string(),
                                                  "--truth", (drive / "truth.tum").string(), "--json"});
  ASSERT_EQ(replay.code, 0) << replay.error;
  EXPECT_LT(nlohmann::json::parse(replay.out)["evaluation"]["ate_m"]["rmse"], 0.05);
}

TEST_F(StudyCommand, SaysWhatIsWrong) {
  const std::string output = (folder_->path() / "none").string();
  const test::Outcome outcome = test::run_landfix({"study", "--output", output, "--sensors", "vlp16,vlp17"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.error, testing::HasSubstr("vlp17"));
  EXPECT_EQ(test::run_landfix({"study", "--output", output, "--routes", "Z"}).code, 2);
  EXPECT_EQ(test::run_landfix({"study", "--output", output, "--jobs", "0"}).code, 2);
  EXPECT_EQ(test::run_landfix({"study", "--output", output, "--length", "100000"}).code, 2);
  EXPECT_EQ(test::run_landfix({"study", "--output", output, "--routes", "A,A"}).code, 2);
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST_F(StudyCommand, LeavesAloneWhatItHasNotMade) {
  const auto output = folder_->path() / "mine";
  const auto capture = output / "A-vlp16" / "capture.pcap";
  std::filesystem::create_directories(capture.parent_path());
  std::ofstream(capture) << "dear to somebody";
  const test::Outcome outcome = test::run_landfix(
      {"study", "--output", output.string(), "--routes", "A", "--sensors", "vlp16", "--length", "100"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, testing::HasSubstr("no study has made it"));
  EXPECT_EQ(test::text_of(capture.string()), "dear to somebody");
}

}  // namespace
}  // namespace landfix::tools
