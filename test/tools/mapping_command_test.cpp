#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "platform/trajectory.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"

namespace landfix::tools {
namespace {

/// 80 m of a street, driven and mapped once for all tests.
class MappingCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryDirectory();
    const test::Outcome outcome = test::run_landfix({"simulate", "--route", "street", "--sensor", "vlp16",
                                                     "--length", "80", "--scans", "--output", path("drive")});
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    ours_ = map_capture("ours");
  }
  static void TearDownTestSuite() { delete folder_; }

  [[nodiscard]] static std::string path(const std::string& name) { return (folder_->path() / name).string(); }

  /// Of the sensor on the simulated vehicle.
  [[nodiscard]] static std::string sensor_pose() {
    const std::string config = test::text_of(path("drive/config.toml"));
    const std::size_t begin = config.find('[', config.find("sensor_pose"));
    return config.substr(begin + 1, config.find(']', begin) - begin - 1);
  }
  [[nodiscard]] static std::string without_spaces(std::string text) {
    std::erase(text, ' ');
    return text;
  }
  [[nodiscard]] static nlohmann::json map_capture(const std::string& output,
                                                  std::vector<std::string> more = {}) {
    more.insert(more.begin(),
                {"mapping", "--pcap", path("drive/capture.pcap"), "--sensor", "vlp16", "--sensor-pose",
                 without_spaces(sensor_pose()), "--output", path(output), "--json"});
    const test::Outcome outcome = test::run_landfix(more);
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    return nlohmann::json::parse(outcome.out);
  }
  [[nodiscard]] static nlohmann::json errors_of(const std::string& output, const std::string& truth) {
    const test::Outcome outcome =
        test::run_landfix({"evaluate", "--reference", path(truth), "--estimate",
                           path(output + "/trajectory.tum"), "--align", "first", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    return nlohmann::json::parse(outcome.out);
  }

  static inline test::TemporaryDirectory* folder_ = nullptr;
  static inline nlohmann::json ours_;  ///< what mapping it into "ours" said
};

TEST_F(MappingCommand, MapsACaptureAndDriftsLittle) {
  const nlohmann::json& json = ours_;
  EXPECT_NEAR(json["travelled_m"], 80.0, 1.5);
  EXPECT_GT(json["points"], 1'000'000);
  const nlohmann::json errors = errors_of("ours", "drive/truth.tum");
  EXPECT_LT(errors["ate_m"]["max"], 0.4);
  EXPECT_LT(errors["heading_deg"]["rmse"], 0.1);
  EXPECT_LT(errors["elevation_m"]["max"], 0.15);
}

TEST_F(MappingCommand, TheStudysSettingsDriftMore) {
  const nlohmann::json ours = errors_of("ours", "drive/truth.tum");
  const nlohmann::json json = map_capture("study", {"--study-settings"});
  EXPECT_GT(json["iterations_mean"], 1.0);
  const nlohmann::json study = errors_of("study", "drive/truth.tum");
  EXPECT_GT(study["ate_m"]["rmse"], 2.0 * ours["ate_m"]["rmse"].get<double>());
}

TEST_F(MappingCommand, WritesTheSameFilesTwice) {
  const nlohmann::json& json = ours_;
  static_cast<void>(map_capture("second"));
  EXPECT_EQ(test::text_of(path("ours/trajectory.tum")), test::text_of(path("second/trajectory.tum")));
  EXPECT_EQ(test::text_of(path("ours/map.pcd")), test::text_of(path("second/map.pcd")));
  EXPECT_EQ(platform::read_tum(path("ours/trajectory.tum")).size(), json["sweeps"]);
  const std::string metrics = test::text_of(path("ours/metrics.csv"));
  EXPECT_EQ(std::count(metrics.begin(), metrics.end(), '\n'), json["sweeps"].get<int>() + 1);
  // What it wrote is a map for what comes next.
  const test::Outcome map = test::run_landfix(
      {"map", "--pcd", path("ours/map.pcd"), "--output", path("ours.ndt"), "--resolution", "1", "--json"});
  EXPECT_EQ(map.code, 0) << map.error;
  EXPECT_EQ(nlohmann::json::parse(map.out)["points"], json["points"]);
}

TEST_F(MappingCommand, MapsScansFromAGivenPose) {
  const test::Outcome outcome =
      test::run_landfix({"mapping", "--scans", path("drive/scans"), "--stamps", path("drive/scans.tum"),
                         "--initial-pose", "10,20,3,0,0,90", "--output", path("scans"), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const auto trajectory = platform::read_tum(path("scans/trajectory.tum"));
  EXPECT_EQ(trajectory.front().pose.translation(), Eigen::Vector3d(10.0, 20.0, 3.0));
  EXPECT_LT(errors_of("scans", "drive/scans.tum")["ate_m"]["max"], 0.4);
}

TEST_F(MappingCommand, SaysWhatIsWrong) {
  const std::string output = path("none");
  EXPECT_EQ(test::run_landfix({"mapping", "--output", output}).code, 2) << "nothing to map";
  EXPECT_EQ(test::run_landfix({"mapping", "--pcap", path("drive/capture.pcap"), "--study-settings", "--leaf",
                               "1", "--output", output})
                .code,
            2)
      << "the study's leaf is 2 m";
  EXPECT_EQ(test::run_landfix({"mapping", "--scans", path("drive/scans"), "--stamps", path("drive/truth.tum"),
                               "--output", output})
                .code,
            2)
      << "of other times";
  EXPECT_EQ(test::run_landfix({"mapping", "--pcap", path("nothing.pcap"), "--output", output}).code, 1);
}

}  // namespace
}  // namespace landfix::tools
