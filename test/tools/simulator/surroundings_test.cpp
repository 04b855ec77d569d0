// The surroundings that are not streets: a tunnel, an open field.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tools/simulator/drive.hpp"
#include "tools/simulator/survey.hpp"
#include "tools/simulator/tunnel.hpp"

namespace landfix::tools::simulator {
namespace {

/// With the route's own seed.
Drive drive_through(const Route& route) { return {route, route.seed}; }

Route tunnel_with_niches(double spacing_m) {
  Route route = shortened(load_route("tunnel"), 40.0);
  route.tunnel->niche_spacing_m = spacing_m;
  return route;
}

/// From the middle of the road, `height_m` above the line that is driven; `left` and `up` give the direction.
std::optional<double> range_across(const Drive& drive, double station_m, double height_m, double left,
                                   double up) {
  const PathPoint point = drive.ground().path().at(station_m);
  const Eigen::Vector2d middle_m =
      point.position_m.head<2>() + drive.ground().road().centre_offset_m() * point.left();
  const Eigen::Vector2d aside = left * point.left();
  const Ray ray{{middle_m.x(), middle_m.y(), point.position_m.z() + height_m},
                Eigen::Vector3d(aside.x(), aside.y(), up).normalized(),
                50.0};
  const std::optional<Hit> hit = drive.scene().cast(ray, {}, 0.0);
  return hit ? std::optional(hit->range_m) : std::nullopt;
}

TEST(Tunnel, ItsWallsAndVaultAreWhereTheyShouldBeAllAlongIt) {
  const Drive drive = drive_through(tunnel_with_niches(0.0));
  constexpr double kHalfWidth_m = 4.75;
  constexpr double kSagitta_m = 0.006;  // between the arc and its facets
  for (double s = -79.0; s < 119.0; s += 0.7) {
    for (const double left : {-1.0, 1.0}) {
      ASSERT_NEAR(range_across(drive, s, 1.0, left, 0.0).value_or(0.0), kHalfWidth_m, 0.001) << s;
    }
    for (double angle_rad = 0.0; angle_rad < std::numbers::pi; angle_rad += 0.1) {
      const auto range_m = range_across(drive, s, 2.2, std::cos(angle_rad), std::sin(angle_rad));
      ASSERT_NEAR(range_m.value_or(0.0), kHalfWidth_m, kSagitta_m) << s << ' ' << angle_rad;
    }
  }
}

TEST(Tunnel, NichesAreInTheRightWallAtMultiplesOfTheirSpacing) {
  const Drive drive = drive_through(tunnel_with_niches(25.0));
  for (double s = -79.05; s < 119.0; s += 0.3) {
    const double from_niche_m = std::abs(std::remainder(s, 25.0));
    if (std::abs(from_niche_m - 0.5 * kNicheWidth_m) < 0.05) continue;
    const double right_m = from_niche_m < 0.5 * kNicheWidth_m ? 4.75 + kNicheDepth_m : 4.75;
    for (const double height_m : {0.3, 2.1}) {
      ASSERT_NEAR(range_across(drive, s, height_m, -1.0, 0.0).value_or(0.0), right_m, 0.001) << s;
      ASSERT_NEAR(range_across(drive, s, height_m, 1.0, 0.0).value_or(0.0), 4.75, 0.001) << s;
    }
  }
}

TEST(Tunnel, IsClosedAllAroundWithNichesToo) {
  const Drive drive = drive_through(tunnel_with_niches(20.0));
  const PathPoint point = drive.ground().path().at(20.0);
  for (double azimuth_rad = 0.1; azimuth_rad < 2.0 * std::numbers::pi; azimuth_rad += 0.013) {
    for (double elevation_rad = -1.5; elevation_rad < 1.5; elevation_rad += 0.013) {
      const double along = std::cos(azimuth_rad) * std::cos(elevation_rad);
      if (std::abs(along) > 0.98) continue;  // out of an end
      const double across = std::sin(azimuth_rad) * std::cos(elevation_rad);
      const Eigen::Vector2d level = along * point.forward() + across * point.left();
      const Ray ray{point.position_m + Eigen::Vector3d(0.0, 0.0, 1.9),
                    {level.x(), level.y(), std::sin(elevation_rad)},
                    100.0};
      ASSERT_TRUE(drive.scene().cast(ray, {}, 0.0)) << azimuth_rad << ' ' << elevation_rad;
    }
  }
}

TEST(Tunnel, NothingIsSurveyedOutsideIt) {
  const Drive drive = drive_through(tunnel_with_niches(0.0));
  const auto points_m = survey(drive.world().surveyed, drive.ground(), drive.route().survey, drive.seed());
  ASSERT_GT(points_m.size(), 300'000U);
  constexpr double kNoise_m = 6.0 * kSurveyNoise_m;
  for (const Eigen::Vector3f& point_m : points_m) {
    const Eigen::Vector2d xy_m = point_m.head<2>().cast<double>();
    ASSERT_LT(drive.ground().distance_to_road_m(xy_m), 4.75 + kNoise_m);
    ASSERT_GT(static_cast<double>(point_m.z()), -0.1 - kNoise_m);
    ASSERT_LT(static_cast<double>(point_m.z()), 6.95 + kNoise_m);
  }
}

TEST(Field, IsLevelWithNothingOnItFor150Metres) {
  const Drive drive = drive_through(shortened(load_route("field"), 30.0));
  constexpr double kUneven_m = 0.03;
  for (const Eigen::Vector3f& vertex_m : drive.world().surveyed.vertices_m) {
    ASSERT_LT(std::abs(vertex_m.z()), static_cast<float>(kUneven_m));
  }
  EXPECT_TRUE(drive.world().parked.triangles.empty());
  EXPECT_TRUE(drive.world().traffic.empty());
  for (double x_m = -100.0; x_m <= 100.0; x_m += 3.7) {
    for (double y_m = -100.0; y_m <= 100.0; y_m += 3.7) {
      const Ray plumb{{x_m, y_m, 5.0}, {0.0, 0.0, -1.0}, 10.0};
      const std::optional<Hit> hit = drive.scene().cast(plumb, {}, 0.0);
      ASSERT_TRUE(hit) << x_m << ' ' << y_m;
      ASSERT_NEAR(hit->range_m, 5.0, kUneven_m);
    }
  }
  // Light that goes up or level meets nothing.
  for (double azimuth_rad = 0.0; azimuth_rad < 2.0 * std::numbers::pi; azimuth_rad += 0.01) {
    for (const double up : {0.0, 0.02, 0.1, 0.5}) {
      const Eigen::Vector3d direction(std::cos(azimuth_rad), std::sin(azimuth_rad), up);
      ASSERT_FALSE(drive.scene().cast({{0.0, 0.0, 0.1}, direction.normalized(), 300.0}, {}, 0.0));
    }
  }
}

TEST(Field, EveryVoxelOfItsMapHasPointsEnough) {
  const Drive drive = drive_through(shortened(load_route("field"), 30.0));
  const auto points_m = survey(drive.world().surveyed, drive.ground(), drive.route().survey, drive.seed());
  constexpr int kHalf_m = 90;
  constexpr int kSide = 2 * kHalf_m;
  std::vector<int> counts(static_cast<std::size_t>(kSide) * kSide, 0);
  for (const Eigen::Vector3f& point_m : points_m) {
    const int column = static_cast<int>(std::floor(point_m.x())) + kHalf_m;
    const int row = static_cast<int>(std::floor(point_m.y())) + kHalf_m;
    if (column < 0 || row < 0 || column >= kSide || row >= kSide) continue;
    ++counts[static_cast<std::size_t>(row * kSide + column)];
  }
  const auto poor = std::ranges::count_if(counts, [](int count) { return count < 6; });
  EXPECT_LT(poor, std::ssize(counts) / 100);
}

}  // namespace
}  // namespace landfix::tools::simulator
