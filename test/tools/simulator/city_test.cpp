#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "support/test_route.hpp"
#include "tools/simulator/drive.hpp"
#include "tools/simulator/survey.hpp"

namespace landfix::tools::simulator {
namespace {

/// Two by two blocks; the drive crosses its middle along the street from west to east.
constexpr double kSide_m = 200.0;
const std::string kSmallCity = R"(
seed = 9
[road]
parking_width_m = 2.0
pavement_width_m = 3.0
[city]
side_m = 200.0
columns = 2
rows = 2
west_m = -85.0
south_m = -98.375
[survey]
spacing_m = 0.3
[scenery]
parked_cars_per_100m = 12.0
[[segment]]
length_m = 30.0
speed_kmh = 30.0
)";

class CityTest : public ::testing::Test {
 protected:
  const Drive drive_{test::route_of(kSmallCity), 9};
  const Ground& ground_ = drive_.ground();
  const Eigen::Vector2d south_west_m_ = ground_.streets()->south_west_m;
};

TEST_F(CityTest, KnowsTheWayToTheNearestStreet) {
  const double half_width_m = ground_.road().half_width_m();
  const auto distance_m = [this](double east_m, double north_m) {
    return ground_.distance_to_road_m(south_west_m_ + Eigen::Vector2d(east_m, north_m));
  };
  EXPECT_NEAR(distance_m(50.0, 100.0), 0.0, 1e-9) << "middle of a street";
  EXPECT_NEAR(distance_m(50.0, 103.0), 3.0, 1e-9);
  EXPECT_NEAR(distance_m(50.0, 97.0), 3.0, 1e-9);
  EXPECT_NEAR(distance_m(93.0, 50.0), 7.0, 1e-9) << "on a pavement";
  EXPECT_NEAR(distance_m(50.0, 50.0), 50.0, 1e-9) << "middle of a block";
  EXPECT_EQ(distance_m(101.0, 99.0), 0.0) << "a crossing";
  EXPECT_NEAR(distance_m(0.0, 100.0), 0.0, 1e-9) << "the edge of the city";
  // The kerb is round where streets meet: its corner belongs to the carriageway.
  EXPECT_LT(distance_m(100.0 + half_width_m + 0.5, 100.0 + half_width_m + 0.5), half_width_m);
  EXPECT_GT(distance_m(100.0 + half_width_m + 3.0, 100.0 + half_width_m + 3.0), half_width_m);
}

TEST_F(CityTest, HasGroundAllOverItsSquareAsHighAsItSays) {
  const Mesh ground = ground_.mesh();
  const std::array<const Mesh*, 1> one{&ground};
  const Scene scene(one, {});
  for (double east_m = 0.1; east_m < kSide_m; east_m += 0.93) {
    for (double north_m = 0.1; north_m < kSide_m; north_m += 0.93) {
      const Eigen::Vector2d xy_m = south_west_m_ + Eigen::Vector2d(east_m, north_m);
      const double height_m = ground_.height_m(xy_m);
      const Ray plumb{{xy_m.x(), xy_m.y(), height_m + 1.0}, {0.0, 0.0, -1.0}, 2.0};
      const std::optional<Hit> hit = scene.cast(plumb, {}, 0.0);
      ASSERT_TRUE(hit) << east_m << ' ' << north_m;
      const double half_width_m = ground_.road().half_width_m();
      const bool at_kerb = std::abs(ground_.distance_to_road_m(xy_m) - half_width_m) < 0.15;
      ASSERT_NEAR(hit->range_m, 1.0, at_kerb ? 0.15 : 0.01) << east_m << ' ' << north_m;
    }
  }
}

TEST_F(CityTest, IsSurveyedAllOverItsSquareAndNowhereElse) {
  constexpr std::size_t kCells = 20;
  constexpr double kCell_m = kSide_m / kCells;
  std::vector<int> counts(kCells * kCells, 0);
  double highest_m = 0.0;
  survey(drive_.world().surveyed, ground_, drive_.route().survey, drive_.seed(),
         [&](const Eigen::Vector3f& point_m) {
           const Eigen::Array2d from_corner_m = (point_m.head<2>().cast<double>() - south_west_m_).array();
           ASSERT_GT(from_corner_m.minCoeff(), -0.1);
           ASSERT_LT(from_corner_m.maxCoeff(), kSide_m + 0.1);
           const Eigen::Array2d cell = (from_corner_m / kCell_m).max(0.0).min(kCells - 1.0);
           ++counts[static_cast<std::size_t>(cell.y()) * kCells + static_cast<std::size_t>(cell.x())];
           highest_m = std::max(highest_m, static_cast<double>(point_m.z()));
         });
  EXPECT_GT(*std::ranges::min_element(counts), 100);
  EXPECT_GT(highest_m, 5.0);
}

TEST_F(CityTest, HasHousesAlongEveryStreet) {
  for (const double street_m : {0.0, 100.0, kSide_m}) {
    for (const bool north_south : {false, true}) {
      for (const double side : {-1.0, 1.0}) {
        if (std::abs(street_m + side - 100.0) > 101.0 || street_m + side < 0.0 || street_m + side > kSide_m)
          continue;
        int seen = 0;
        for (double along_m = 20.0; along_m < kSide_m; along_m += 2.0) {
          const Eigen::Vector2d place_m =
              north_south ? Eigen::Vector2d(street_m, along_m) : Eigen::Vector2d(along_m, street_m);
          const Eigen::Vector2d across =
              north_south ? Eigen::Vector2d(side, 0.0) : Eigen::Vector2d(0.0, side);
          const Eigen::Vector2d xy_m = south_west_m_ + place_m;
          const Ray ray{{xy_m.x(), xy_m.y(), 2.8}, {across.x(), across.y(), 0.0}, 12.0};
          if (drive_.scene().cast(ray, {}, 0.0)) ++seen;
        }
        EXPECT_GT(seen, 45) << street_m << ' ' << north_south << ' ' << side;
      }
    }
  }
}

TEST_F(CityTest, NothingStandsOnTheLanes) {
  const double first_m = south_west_m_.x() + 1.0;
  for (const double offset_m : {-2.5, -0.7, 0.7, 2.5}) {
    for (const double middle_m : {0.0, 100.0, kSide_m}) {
      const double y_m = south_west_m_.y() + middle_m + offset_m;
      const Ray ray{{first_m, y_m, 0.5}, {1.0, 0.0, 0.0}, kSide_m - 2.0};
      ASSERT_FALSE(drive_.scene().cast(ray, {}, 0.0)) << offset_m << ' ' << middle_m;
    }
  }
}

TEST_F(CityTest, ParkedCarsStandBesideTheKerb) {
  ASSERT_GT(drive_.world().parked.triangles.size(), 1000U);
  for (const Eigen::Vector3f& vertex_m : drive_.world().parked.vertices_m) {
    const double from_middle_m = ground_.distance_to_road_m(vertex_m.head<2>().cast<double>());
    ASSERT_GT(from_middle_m, 3.25 - 0.15) << "who parks askew";
    ASSERT_LT(from_middle_m, ground_.road().half_width_m() + 0.2);
  }
}

TEST(CityRoute, KeepsToTheRightLaneAndTurnsWithinTheKerbs) {
  const Route route = load_route("city");
  const Path path(route);
  const Ground ground(path, route, {}, route.seed);
  constexpr double kHalfCar_m = 0.95;
  for (double s = path.first_station_m(); s <= path.last_station_m(); s += 0.5) {
    const PathPoint point = path.at(s);
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector2d xy_m = point.position_m.head<2>() + side * kHalfCar_m * point.left();
      ASSERT_LT(ground.distance_to_road_m(xy_m), route.road.half_width_m() - 0.5) << s;
    }
  }
  double start_m = 0.0;
  for (const RouteSegment& segment : route.segments) {
    const PathPoint before_crossing = path.at(start_m + 0.25 * segment.length_m);
    start_m += segment.length_m;
    if (segment.curvature_1pm != 0.0) continue;
    const Eigen::Vector2d right = -before_crossing.left();
    const Eigen::Vector2d xy_m = before_crossing.position_m.head<2>();
    const double lane_m = 0.5 * route.road.lane_width_m;
    EXPECT_NEAR(ground.distance_to_road_m(xy_m), lane_m, 0.15) << start_m;
    EXPECT_GT(ground.distance_to_road_m(xy_m + 0.5 * right), lane_m) << start_m;
  }
}

}  // namespace
}  // namespace landfix::tools::simulator
