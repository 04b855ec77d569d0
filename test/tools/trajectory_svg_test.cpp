#include "tools/trajectory_svg.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/xml.hpp"
#include "tools/map_raster.hpp"

namespace landfix::tools {
namespace {

using platform::StampedPose;
using test::is_well_formed;
using ::testing::HasSubstr;
using ::testing::Not;

StampedPose pose_at(int i, double sideways_m) {
  return {std::int64_t{i} * 100'000'000,
          ndt::make_pose({1.0 * i, 20.0 * std::sin(0.05 * i) + sideways_m, 0.0}, {})};
}

std::vector<StampedPose> drive(double sideways_m) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 200; ++i) poses.push_back(pose_at(i, sideways_m));
  return poses;
}

/// A level plane of 120 m by 120 m with a wall across it.
std::vector<Eigen::Vector3f> plane_with_a_wall(float spacing_m) {
  std::vector<Eigen::Vector3f> points;
  for (float x = 0.0F; x < 120.0F; x += spacing_m) {
    for (float y = -60.0F; y < 60.0F; y += spacing_m) points.emplace_back(x, y, 0.0F);
    for (float z = 0.0F; z < 6.0F; z += spacing_m) points.emplace_back(x, 30.0F, z);
  }
  return points;
}

TEST(TrajectorySvg, ShowsMapTrajectoryTruthAndErrors) {
  const std::string svg = trajectory_svg(plane_with_a_wall(0.5F), drive(0.03), drive(0.0));
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_THAT(svg, HasSubstr("id=\"map\""));
  EXPECT_THAT(svg, HasSubstr("id=\"trajectory\""));
  EXPECT_THAT(svg, HasSubstr("id=\"truth\""));
  EXPECT_THAT(svg, HasSubstr("position 3.0 cm"));
  EXPECT_THAT(svg, HasSubstr("5 cm</text>"));  // the legend's end
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(TrajectorySvg, WithoutTruthItShowsTheLineAlone) {
  const std::string svg = trajectory_svg(plane_with_a_wall(0.5F), drive(0.0));
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_THAT(svg, HasSubstr("id=\"trajectory\""));
  EXPECT_THAT(svg, Not(HasSubstr("id=\"truth\"")));
  EXPECT_THAT(svg, Not(HasSubstr("cm")));
}

TEST(TrajectorySvg, TruthOfAnotherTimeGivesNoErrors) {
  std::vector<StampedPose> later = drive(0.0);
  for (StampedPose& pose : later) pose.stamp_utc_ns += 1'000'000'000'000;
  const std::string svg = trajectory_svg({}, drive(0.0), later);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_THAT(svg, Not(HasSubstr("RMSE")));
}

TEST(TrajectorySvg, NeedsNeitherAMapNorAWay) {
  const std::vector<StampedPose> one{pose_at(3, 0.0)};
  for (const std::string& svg :
       {trajectory_svg({}, {}), trajectory_svg({}, one), trajectory_svg({}, one, one),
        trajectory_svg({}, {}, drive(0.0)), trajectory_svg({}, drive(0.0), drive(0.0))}) {
    EXPECT_TRUE(is_well_formed(svg));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
  }
}

TEST(TrajectorySvg, StaysSmallOverALargeRaggedMap) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 2'000'000; ++i) {
    const auto u = static_cast<float>(std::fmod(i * 0.618034, 1.0));
    const auto v = static_cast<float>(std::fmod(i * 0.754878, 1.0));
    points.emplace_back(400.0F * u - 100.0F, 300.0F * v - 150.0F, 8.0F * std::sin(static_cast<float>(i)));
  }
  EXPECT_LT(trajectory_svg(points, drive(0.1), drive(0.0)).size(), 2'000'000U);
}

TEST(MapRaster, ChoosesCellsAsFineAsThePointsAllow) {
  const Eigen::AlignedBox2d area_m(Eigen::Vector2d(0.0, -60.0), Eigen::Vector2d(120.0, 60.0));
  EXPECT_DOUBLE_EQ(rasterise(plane_with_a_wall(0.2F), area_m).cell_m, 0.25);
  EXPECT_DOUBLE_EQ(rasterise(plane_with_a_wall(1.0F), area_m).cell_m, 1.0);
}

TEST(MapRaster, ShadesWallsDarkerThanGround) {
  const Eigen::AlignedBox2d area_m(Eigen::Vector2d(0.0, -60.0), Eigen::Vector2d(120.0, 60.0));
  const MapRaster raster = rasterise(plane_with_a_wall(0.5F), area_m);
  EXPECT_FALSE(raster.paths[0].empty());
  EXPECT_FALSE(raster.paths[kShades - 1].empty());
  EXPECT_LT(raster.paths[kShades - 1].size(), raster.paths[0].size());
}

TEST(MapRaster, LeavesOutWhatIsNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<Eigen::Vector3f> points{{nan, 0, 0}, {1, 1, infinity}, {infinity, 1, 1}, {1e30F, 1, 1}};
  const Eigen::AlignedBox2d area_m(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(10.0, 10.0));
  for (const std::string& path : rasterise(points, area_m).paths) EXPECT_TRUE(path.empty());
}

}  // namespace
}  // namespace landfix::tools
