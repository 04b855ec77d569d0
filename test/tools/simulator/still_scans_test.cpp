#include "tools/simulator/still_scans.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "platform/trajectory.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"
#include "support/test_route.hpp"
#include "tools/input_files.hpp"

namespace landfix::tools::simulator {
namespace {

TEST(StillScans, AreOneForEachWholeTurnWithThePoseAtItsEnd) {
  const test::TemporaryDirectory folder;
  const Drive drive(test::route_of(test::kBareRoute), 6);
  write_still_scans(drive, folder.path(), [](double) {});
  const auto truth = platform::read_tum(folder.path() / "scans.tum");
  const auto scans = list_clouds(folder.path() / "scans");
  EXPECT_EQ(scans.size(), truth.size());
  constexpr double kTurn_s = 0.1;
  const auto seconds_in = [](const ndt::StampedPose& pose) {
    return 1e-9 * static_cast<double>(pose.stamp_utc_ns - kDriveStart_utc_ns);
  };
  EXPECT_GE(seconds_in(truth.front()), kTurn_s);
  EXPECT_LT(seconds_in(truth.front()), 2.0 * kTurn_s);
  EXPECT_LE(seconds_in(truth.back()), drive.vehicle().duration_s());
  EXPECT_GT(seconds_in(truth.back()), drive.vehicle().duration_s() - 1.1 * kTurn_s);
  EXPECT_EQ(scans.front().filename(), "0000.pcd");
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_EQ(truth[i].stamp_utc_ns, truth[0].stamp_utc_ns + static_cast<std::int64_t>(i) * 100'000'000);
    const ndt::Pose there = drive.vehicle().pose_at(seconds_in(truth[i]));
    EXPECT_LT((truth[i].pose.translation() - there.translation()).norm(), 1e-5);
  }
}

TEST(StillScans, LieOnTheMapAtTheirTruthAlthoughTheVehicleMoves) {
  const test::TemporaryDirectory folder;
  const Drive drive(test::route_of(test::kBareRoute), 6);  // at 20 km/h, 56 cm a turn
  write_drive(drive, folder.path(), [](double) {});
  write_still_scans(drive, folder.path(), [](double) {});
  const auto path = [&folder](const char* name) { return (folder.path() / name).string(); };
  const test::Outcome outcome =
      test::run_landfix({"benchmark", "--map", path("map.pcd"), "--scans", path("scans"), "--truth",
                         path("scans.tum"), "--starts", "1", "--perturb", "0.1,0.5", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["ok_percent"], 100.0);
  EXPECT_LT(json["error_cm"]["p95"], 5.0);
}

}  // namespace
}  // namespace landfix::tools::simulator
