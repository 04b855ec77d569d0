// `landfix benchmark` on a yard of a few thousand points, with two scans of it.
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ndt/random_world.hpp"
#include "platform/pcd_writer.hpp"
#include "platform/trajectory.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"
#include "tools/pcl_rival.hpp"

namespace landfix::tools {
namespace {

using test::Outcome;
using testing::HasSubstr;

class BenchmarkCommand : public testing::Test {
 protected:
  BenchmarkCommand() {
    const std::vector<Eigen::Vector3d> cloud = ndt::test::random_yard(1, 20'000);
    std::filesystem::create_directory(folder_.path() / "scans");
    write("map.pcd", ndt::test::seen_from(cloud, ndt::Pose::Identity()));
    std::vector<ndt::StampedPose> truth(2);
    truth[1].stamp_utc_ns = 100'000'000;
    truth[1].pose = ndt::make_pose({0.6, -0.2, 0.0}, {.yaw_rad = 0.1});
    for (std::size_t i = 0; i < truth.size(); ++i)
      write("scans/" + std::to_string(i) + ".pcd", ndt::test::seen_from(cloud, truth[i].pose));
    platform::write_tum(folder_.path() / "truth.tum", truth);
  }

  void write(const std::string& name, const std::vector<Eigen::Vector3f>& points_m) const {
    platform::write_pcd_records(folder_.path() / name, platform::kPositionMembers,
                                std::as_bytes(std::span(points_m)), sizeof(Eigen::Vector3f));
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  [[nodiscard]] Outcome benchmark(const std::vector<std::string>& more,
                                  const std::string& map = "map.pcd") const {
    std::vector<std::string> words{
        "benchmark",   "--map", path(map), "--scans", path("scans"), "--truth", path("truth.tum"),
        "--min-range", "0",     "--leaf",  "0.5",     "--starts",    "3"};
    words.insert(words.end(), more.begin(), more.end());
    return test::run_landfix(words);
  }

 private:
  test::TemporaryDirectory folder_;
};

TEST_F(BenchmarkCommand, MeasuresAccuracyTimeAndMap) {
  const Outcome outcome = benchmark({"--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["scans"], 2);
  EXPECT_EQ(json["starts"], 6);
  EXPECT_EQ(json["ok_percent"], 100.0);
  EXPECT_GT(json["points_mean"], 1000.0);
  EXPECT_LT(json["points_mean"], 20'000.0);
  EXPECT_GT(json["iterations_mean"], 1.0);
  EXPECT_LE(json["error_cm"]["median"], json["error_cm"]["p95"]);
  EXPECT_LE(json["error_deg"]["median"], json["error_deg"]["p95"]);
  EXPECT_LE(json["bias_cm"]["all"], json["error_cm"]["p95"]);
  EXPECT_EQ(json["bias_cm"]["all"], json["bias_cm"]["ok"]);
  for (const char* const stage : {"filter_cpu_ms", "match_cpu_ms"}) {
    EXPECT_GT(json[stage]["median"], 0.0) << stage;
    EXPECT_LE(json[stage]["median"], json[stage]["p99"]) << stage;
  }
  EXPECT_GE(json["match_cpu_ms"]["p99_to_median"], 1.0);
  const nlohmann::json& map = json["map"];
  EXPECT_DOUBLE_EQ(map["bytes_per_voxel"].get<double>(),
                   map["bytes"].get<double>() / map["voxels"].get<double>());
  EXPECT_GT(map["read_ms"], 0.0);
  EXPECT_GT(map["build_ms"], 0.0);
  EXPECT_FALSE(json.contains("rival"));
  EXPECT_FALSE(json.contains("ratio"));
}

TEST_F(BenchmarkCommand, BuildsNothingOfAFinishedMap) {
  ASSERT_EQ(
      test::run_landfix({"map", "--pcd", path("map.pcd"), "--resolution", "1", "--output", path("map.ndt")})
          .code,
      0);
  const Outcome outcome = benchmark({"--json"}, "map.ndt");
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["ok_percent"], 100.0);
  EXPECT_TRUE(json["map"]["build_ms"].is_null());
  EXPECT_TRUE(json["map"]["read_ms"].is_null());
}

TEST_F(BenchmarkCommand, GivesTheRivalTheFirstStartsOfEachScan) {
  if (!PclRival::available()) GTEST_SKIP() << "built without PCL (libpcl-dev)";
  const Outcome outcome = benchmark({"--rival", "pcl", "--rival-starts", "2", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["starts"], 6);
  const nlohmann::json& rival = json["rival"];
  EXPECT_THAT(rival["name"].get<std::string>(), testing::StartsWith("PCL 1."));
  EXPECT_EQ(rival["starts"], 4);
  // Of the same scan, range and leaf the same cells are left.
  EXPECT_NEAR(rival["points_mean"].get<double>(), json["points_mean"].get<double>(), 5.0);
  EXPECT_LT(rival["error_cm"]["median"], 10.0);
  EXPECT_GT(rival["iterations_mean"], 1.0);
  EXPECT_GT(rival["map"]["build_ms"], 0.0);
  for (const char* const what : {"match", "filter", "build"}) EXPECT_GT(json["ratio"][what], 0.0) << what;

  const Outcome text = benchmark({"--rival", "pcl", "--rival-starts", "9"});
  ASSERT_EQ(text.code, 0) << text.error;
  EXPECT_THAT(text.out, HasSubstr("6 of these starts"));  // there are no more
  EXPECT_THAT(text.out, HasSubstr("landfix takes less by a factor of"));
}

TEST_F(BenchmarkCommand, TracksInSequence) {
  const Outcome outcome = benchmark({"--sequence"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_THAT(outcome.out, HasSubstr("2, 2 starts"));
  EXPECT_THAT(outcome.out, HasSubstr("100.00 %"));
}

TEST_F(BenchmarkCommand, RefusesWhatDoesNotGoTogether) {
  const auto expect = [](const Outcome& outcome, const std::string& part) {
    EXPECT_EQ(outcome.code, 2) << part;
    EXPECT_THAT(outcome.error, HasSubstr(part));
    EXPECT_EQ(outcome.out, "");
  };
  expect(benchmark({"--rival", "pcl"}, "map.ndt"), ".pcd");
  expect(benchmark({"--rival", "icp"}), "--rival");
  expect(benchmark({"--rival-starts", "0"}), "--rival-starts");
  expect(benchmark({"--sequence", "--perturb", "1,1"}), "--sequence");
  write("scans/2.pcd", std::vector<Eigen::Vector3f>(9, Eigen::Vector3f::Ones()));
  expect(benchmark({}), "has 3 scans, " + path("truth.tum") + " has 2 poses");
}

}  // namespace
}  // namespace landfix::tools
