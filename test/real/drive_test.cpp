// Matching on a real drive with known poses (PandaSet 002): `landfix benchmark` as its users run it.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/run_landfix.hpp"
#include "support/test_data.hpp"

namespace landfix::tools {
namespace {

[[nodiscard]] nlohmann::json benchmark(const std::filesystem::path& drive,
                                       const std::vector<std::string>& more) {
  std::vector<std::string> words{
      "benchmark",     "--map",   drive / "map.pcd",   "--resolution", "1", "--scans",
      drive / "scans", "--truth", drive / "truth.tum", "--leaf",       "2", "--json"};
  words.insert(words.end(), more.begin(), more.end());
  const test::Outcome outcome = test::run_landfix(words);
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  return nlohmann::json::parse(outcome.out);
}

TEST(RealDrive, IsMatchedFromTwentyStartsAScan) {
  LANDFIX_REAL_DATA(drive, "drive-pandaset-002");
  const nlohmann::json result = benchmark(drive, {"--starts", "20", "--perturb", "0.5,2"});
  EXPECT_EQ(result["starts"], 28 * 20);
  EXPECT_GE(result["ok_percent"], 99.0);
  EXPECT_LE(result["error_cm"]["median"], 5.0);
  EXPECT_LE(result["error_deg"]["median"], 0.15);
}

TEST(RealDrive, IsTrackedInSequence) {
  LANDFIX_REAL_DATA(drive, "drive-pandaset-002");
  const nlohmann::json result = benchmark(drive, {"--sequence"});
  EXPECT_EQ(result["starts"], 28);
  EXPECT_EQ(result["ok_percent"], 100.0);
  // All that is resident, the index included.
  EXPECT_LE(result["map"]["bytes"].get<double>(), 96.0 * result["map"]["voxels"].get<double>());
}

TEST(RealDrive, IsLocatedFromEachScanAlone) {
  LANDFIX_REAL_DATA(drive, "drive-pandaset-002");
  const test::TemporaryDirectory folder;
  const std::string map = folder.path() / "map.ndt";
  ASSERT_EQ(test::run_landfix({"map", "--pcd", drive / "map.pcd", "--resolution", "1", "--output", map}).code,
            0);
  for (const std::string within : {"", "20"}) {
    std::vector<std::string> words{
        "locate", "--map", map,     "--scans", drive / "scans", "--truth", drive / "truth.tum",
        "--leaf", "2",     "--json"};
    if (!within.empty()) words.insert(words.end(), {"--within", within});
    const test::Outcome outcome = test::run_landfix(words);
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    const nlohmann::json result = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(result["scans"], 28);
    EXPECT_GE(result["right"], 27);
    EXPECT_GE(result["sure"], 25);
    EXPECT_EQ(result["wrong_and_sure"], 0);
  }
}

}  // namespace
}  // namespace landfix::tools
