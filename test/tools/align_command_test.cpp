#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ndt/degenerate_world.hpp"
#include "platform/pcd_writer.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"

namespace landfix::tools {
namespace {

void write(const std::filesystem::path& path, const std::vector<Eigen::Vector3d>& points_m) {
  std::vector<Eigen::Vector3f> records;
  for (const Eigen::Vector3d& point_m : points_m) records.emplace_back(point_m.cast<float>());
  platform::write_pcd_records(path, platform::kPositionMembers, std::as_bytes(std::span(records)),
                              sizeof(Eigen::Vector3f));
}

/// A scan of `seen` in a map of `world`, from 0.2 m ahead and 0.1 m to the left.
[[nodiscard]] test::Outcome align(const std::vector<Eigen::Vector3d>& world,
                                  const std::vector<Eigen::Vector3d>& seen, bool json) {
  const test::TemporaryDirectory directory;
  write(directory.path() / "world.pcd", world);
  write(directory.path() / "scan.pcd", seen);
  const test::Outcome mapped =
      test::run_landfix({"map", "--pcd", directory.path() / "world.pcd", "--resolution", "1", "--output",
                         directory.path() / "map.ndt"});
  EXPECT_EQ(mapped.code, 0) << mapped.error;
  std::vector<std::string> words{"align",
                                 "--map",
                                 directory.path() / "map.ndt",
                                 "--scan",
                                 directory.path() / "scan.pcd",
                                 "--leaf",
                                 "0.5",
                                 "--guess",
                                 "0.2,0.1,0,0,0,0"};
  if (json) words.emplace_back("--json");
  return test::run_landfix(words);
}

/// A row along each wall, 1.5 m apart.
[[nodiscard]] std::vector<Eigen::Vector2d> rows() {
  std::vector<Eigen::Vector2d> places_m;
  for (int i = 0; i < 17; ++i) {
    places_m.emplace_back(1.5 * i - 12.0, 3.0);
    places_m.emplace_back(1.5 * i - 12.3, -3.0);
  }
  return places_m;
}

TEST(AlignCommand, NamesWhatACorridorDoesNotHold) {
  const auto world = ndt::test::corridor(1, 80000, -40.0, 40.0);
  const auto seen = ndt::test::corridor(2, 3000, -15.0, 15.0);
  const test::Outcome outcome = align(world, seen, true);
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const nlohmann::json result = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(result["weak_directions"].size(), 1U);
  const nlohmann::json& weak = result["weak_directions"][0];
  EXPECT_EQ(weak["axis"], "longitudinal");
  EXPECT_EQ(weak["direction"].size(), 6U);
  EXPECT_NEAR(weak["sigma_m"], 1.0, 0.05);
  ASSERT_EQ(result["covariance"].size(), 36U);
  EXPECT_GT(result["covariance"][0], 100.0 * result["covariance"][7].get<double>());
  EXPECT_NEAR(result["pose"][0], 0.2, 0.05);
  EXPECT_NEAR(result["pose"][1], 0.0, 0.03);
  EXPECT_NE(align(world, seen, false).out.find("not longitudinal (1 sigma"), std::string::npos);
}

TEST(AlignCommand, SaysWhereNoPoseIsToBeBelieved) {
  const auto far_away = ndt::test::corridor(1, 80000, 200.0, 280.0);
  const auto seen = ndt::test::corridor(2, 3000, -15.0, 15.0);
  const test::Outcome outcome = align(far_away, seen, true);
  EXPECT_EQ(outcome.code, 0) << "it has run";
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["fit"], "none");
}

TEST(AlignCommand, ScoresWhatIsAboveTheGroundByItself) {
  const auto world =
      ndt::test::joined(ndt::test::corridor(1, 80000, -40.0, 40.0), ndt::test::pillars(3, 20000, rows()));
  const auto seen =
      ndt::test::joined(ndt::test::corridor(2, 3000, -15.0, 15.0), ndt::test::pillars(4, 2000, rows()));
  const test::Outcome outcome = align(world, seen, true);
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const nlohmann::json result = nlohmann::json::parse(outcome.out);
  EXPECT_TRUE(result["weak_directions"].empty());
  EXPECT_NEAR(result["pose"][0], 0.0, 0.05);
  EXPECT_GT(result["no_ground_points_matched"], 300);
  EXPECT_LT(result["no_ground_points_matched"], result["points_matched"]);
  EXPECT_GT(result["no_ground_nearest_voxel_likelihood"], 1.0);
}

}  // namespace
}  // namespace landfix::tools
