#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ndt/pcd.hpp"
#include "platform/atomic_file.hpp"
#include "platform/pcd_writer.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"
#include "support/xml.hpp"
#include "tools/quality_run.hpp"

namespace landfix::tools {
namespace {

/// A noisy wall of 20 m beside as much ground.
[[nodiscard]] std::vector<Eigen::Vector3f> yard() {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> place_m(0.0F, 20.0F);
  std::normal_distribution<float> noise_m(0.0F, 0.02F);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 12'000; ++i) {
    points.emplace_back(place_m(random), place_m(random), noise_m(random));
    points.emplace_back(place_m(random), 10.0F * noise_m(random), 0.2F * place_m(random));
  }
  return points;
}

class QualityCommand : public testing::Test {
 protected:
  QualityCommand() {
    const auto points = yard();
    platform::write_pcd_records(path("yard.pcd"), platform::kPositionMembers,
                                std::as_bytes(std::span(points)), sizeof(points[0]));
  }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (directory_.path() / name).string();
  }
  [[nodiscard]] nlohmann::json quality(std::vector<std::string> more) const {
    more.insert(more.begin(), {"quality", "--pcd", path("yard.pcd"), "--radius", "1.0", "--json"});
    const test::Outcome outcome = test::run_landfix(more);
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    return nlohmann::json::parse(outcome.out);
  }

 private:
  test::TemporaryDirectory directory_;
};

TEST_F(QualityCommand, LooksAtEveryPoint) {
  const nlohmann::json json = quality({});
  EXPECT_EQ(json["points"], 24'000);
  EXPECT_EQ(json["skipped"], 0);
  EXPECT_EQ(json["radius_m"], 1.0);
  EXPECT_GT(json["mpv"], 0.02);
  EXPECT_LT(json["mpv"], 0.3);
  EXPECT_TRUE(std::isfinite(json["mme"].get<double>()));
}

TEST_F(QualityCommand, ASampleSeesTheWholeNeighbourhoodAndIsThatOfItsSeed) {
  const nlohmann::json whole = quality({});
  const nlohmann::json sample = quality({"--sample", "4000"});
  EXPECT_EQ(sample["points"], 4'000);
  EXPECT_EQ(sample["cloud_points"], 24'000);
  EXPECT_NEAR(sample["mme"], whole["mme"], 0.05) << "of a thinned cloud it would be that of other points";
  EXPECT_NEAR(sample["mpv"], whole["mpv"], 0.005);
  EXPECT_EQ(quality({"--sample", "4000"})["mme"], sample["mme"]);
  EXPECT_NE(quality({"--sample", "4000", "--seed", "2"})["mme"], sample["mme"]);
  EXPECT_EQ(quality({"--sample", "100000"})["mme"], whole["mme"]) << "more than there are";
}

TEST_F(QualityCommand, WritesWhatItSawOfEachPoint) {
  const nlohmann::json json = quality({"--cloud", path("out.pcd"), "--picture", path("out.svg")});
  double entropy = 0.0;
  double plane_variance_m = 0.0;
  std::size_t points = 0;
  constexpr std::array<std::string_view, 5> kColumns{"x", "y", "z", "entropy", "plane_variance"};
  ndt::visit_pcd(platform::read_file(path("out.pcd")), "out.pcd", kColumns,
                 [&](std::span<const double> values) {
                   ++points;
                   entropy += values[3];
                   plane_variance_m += values[4];
                 });
  EXPECT_EQ(points, 24'000U);
  EXPECT_NEAR(entropy / 24'000.0, json["mme"], 1e-4);
  EXPECT_NEAR(plane_variance_m / 24'000.0, json["mpv"], 1e-6);
  const std::string picture = test::text_of(path("out.svg"));
  EXPECT_TRUE(test::is_well_formed(picture));
  EXPECT_LT(picture.size(), 4'000'000U);
  EXPECT_THAT(picture, testing::HasSubstr("Plane variance"));
}

TEST_F(QualityCommand, SaysWhatIsWrong) {
  EXPECT_EQ(test::run_landfix({"quality"}).code, 2);
  EXPECT_EQ(test::run_landfix({"quality", "--pcd", path("yard.pcd"), "--radius", "0"}).code, 2);
  EXPECT_EQ(test::run_landfix({"quality", "--pcd", path("yard.pcd"), path("yard.pcd")}).code, 2) << "twice";
  EXPECT_EQ(test::run_landfix({"quality", "--pcd", path("nothing.pcd")}).code, 1);
  const test::Outcome outcome =
      test::run_landfix({"quality", "--pcd", path("yard.pcd"), "--radius", "0.001", "--json"});
  const nlohmann::json lonely = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(lonely["skipped"], lonely["points"]);
  EXPECT_TRUE(lonely["mme"].is_null());
}

}  // namespace
}  // namespace landfix::tools
