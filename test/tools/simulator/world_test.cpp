#include "tools/simulator/world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "support/test_route.hpp"
#include "tools/simulator/drive.hpp"
#include "tools/simulator/footprint.hpp"
#include "tools/simulator/survey.hpp"

namespace landfix::tools::simulator {
namespace {

TEST(Footprint, OverlapsWhatItCoversAndNothingBeside) {
  const Footprint square{.centre_m = {0, 0}, .axis = {1, 0}, .half_size_m = {1, 1}};
  const double diagonal = std::sqrt(0.5);
  EXPECT_TRUE(square.overlaps({.centre_m = {1.9, 0}, .axis = {1, 0}, .half_size_m = {1, 1}}));
  EXPECT_FALSE(square.overlaps({.centre_m = {2.1, 0}, .axis = {1, 0}, .half_size_m = {1, 1}}));
  EXPECT_TRUE(square.overlaps({.centre_m = {2.3, 0}, .axis = {diagonal, diagonal}, .half_size_m = {1, 1}}));
  // Their bounding boxes overlap, the shapes do not.
  EXPECT_FALSE(
      square.overlaps({.centre_m = {1.8, 1.8}, .axis = {diagonal, diagonal}, .half_size_m = {1, 1}}));
}

/// Houses, ground and parked cars.
class WorldTest : public ::testing::Test {
 protected:
  const Drive drive_{test::route_of(test::kBareRoute), 6};
  const World& world_ = drive_.world();
};

TEST_F(WorldTest, HasCarsParkedThatAreNotSurveyed) {
  ASSERT_GT(world_.parked.triangles.size(), 1000U);
  const std::vector<Eigen::Vector3f> points_m =
      survey(world_.surveyed, drive_.ground(), drive_.route().survey, drive_.seed());
  constexpr float kNear_m = 0.1F;
  std::vector<Eigen::Vector3f> parked_m = world_.parked.vertices_m;
  const auto x_of = [](const Eigen::Vector3f& vertex_m) { return vertex_m.x(); };
  std::ranges::sort(parked_m, {}, x_of);
  // Between ground clearance and waist only cars stand in the parking lane: nothing surveyed may be near
  // them.
  std::size_t looked_at = 0;
  for (const Eigen::Vector3f& point_m : points_m) {
    const Eigen::Vector2d xy_m = point_m.head<2>().cast<double>();
    const double above_m = static_cast<double>(point_m.z()) - drive_.ground().height_m(xy_m);
    if (above_m < 0.35 || above_m > 1.0) continue;
    ++looked_at;
    auto vertex_m = std::ranges::lower_bound(parked_m, point_m.x() - kNear_m, {}, x_of);
    for (; vertex_m != parked_m.end() && vertex_m->x() <= point_m.x() + kNear_m; ++vertex_m) {
      ASSERT_GT((*vertex_m - point_m).norm(), kNear_m);
    }
  }
  EXPECT_GT(looked_at, 1000U);
}

TEST_F(WorldTest, SurveyedPointsLieOnSurfaces) {
  const std::array<const Mesh*, 1> surveyed{&world_.surveyed};
  const Scene scene(surveyed, {});
  const std::vector<Eigen::Vector3f> points_m =
      survey(world_.surveyed, drive_.ground(), drive_.route().survey, drive_.seed());
  ASSERT_GT(points_m.size(), 100'000U);
  constexpr double kNear_m = 0.08;  // four standard deviations along the axis farthest from the normal
  std::size_t on_surface = 0;
  std::size_t looked_at = 0;
  for (std::size_t i = 0; i < points_m.size(); i += 97) {
    ++looked_at;
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
      const Ray ray{points_m[i].cast<double>() - kNear_m * axis, axis, 2.0 * kNear_m};
      if (scene.cast(ray, {}, 0.0)) {
        ++on_surface;
        break;
      }
    }
  }
  EXPECT_GT(static_cast<double>(on_surface), 0.995 * static_cast<double>(looked_at));
}

TEST_F(WorldTest, HasHousesOnBothSides) {
  const std::array<const Mesh*, 1> surveyed{&world_.surveyed};
  const Scene scene(surveyed, {});
  for (const double side : {-1.0, 1.0}) {
    int seen = 0;
    for (double s = -50.0; s < 70.0; s += 1.0) {
      const Eigen::Vector3d from_m = drive_.ground().point_m({s, 0.0}) + Eigen::Vector3d(0, 0, 3);
      const Eigen::Vector2d left = drive_.ground().path().at(s).left();
      if (scene.cast({from_m, {side * left.x(), side * left.y(), 0.0}, 40.0}, {}, 0.0)) ++seen;
    }
    EXPECT_GT(seen, 30) << side;
  }
}

TEST_F(WorldTest, NothingStandsOnTheLanes) {
  // A box as large as the vehicle, driven along its lane: rays ahead at the height of a bumper meet nothing.
  const std::array<const Mesh*, 2> standing{&world_.surveyed, &world_.parked};
  const Scene scene(standing, {});
  for (double s = 0.0; s < 20.0; s += 1.0) {
    for (const double offset_m : {-1.0, 0.0, 1.0, 3.25}) {
      const Eigen::Vector3d from_m = drive_.ground().point_m({s, offset_m}) + Eigen::Vector3d(0, 0, 0.5);
      const Eigen::Vector3d to_m = drive_.ground().point_m({s + 5.0, offset_m}) + Eigen::Vector3d(0, 0, 0.5);
      const Ray ray{from_m, (to_m - from_m).normalized(), (to_m - from_m).norm()};
      ASSERT_FALSE(scene.cast(ray, {}, 0.0)) << s << ' ' << offset_m;
    }
  }
}

TEST(Ground, FindsTheNearestPlaceOnARoadThatWinds) {
  const Route route = load_route("A");
  const Path path(route);
  const Ground ground(path, route, {}, route.seed);
  for (double x_m = -150.0; x_m < 450.0; x_m += 17.3) {
    for (double y_m = -150.0; y_m < 550.0; y_m += 19.1) {
      const Eigen::Vector2d xy_m(x_m, y_m);
      double least_m = 1e9;
      for (double s = path.first_station_m(); s <= path.last_station_m(); s += 0.5) {
        least_m = std::min(least_m, (path.at(s).position_m.head<2>() - xy_m).norm());
      }
      if (least_m > 35.0) continue;  // farther away a place inside a curve has no single nearest one
      ASSERT_NEAR(std::abs(ground.project(xy_m).offset_m), least_m, 0.1) << x_m << ' ' << y_m;
    }
  }
}

TEST(World, IsClosedBelow) {
  // Wherever one drops a plumb line near the road, there is ground, and it is as high as the ground says.
  const Drive drive(test::route_of(test::kStreetRoute), 8);
  const Mesh ground = drive.ground().mesh();
  const Mesh* const one = &ground;
  const Scene scene(std::span(&one, 1), {});
  for (double s = -70.0; s < 100.0; s += 1.7) {
    for (double offset_m = -40.0; offset_m <= 40.0; offset_m += 0.37) {
      const Eigen::Vector3d point_m = drive.ground().point_m({s, offset_m});
      const double expected_m = drive.ground().height_m(Eigen::Vector2d(point_m.head<2>()));
      const Ray ray{{point_m.x(), point_m.y(), expected_m + 5.0}, {0, 0, -1}, 10.0};
      const std::optional<Hit> hit = scene.cast(ray, {}, 0.0);
      ASSERT_TRUE(hit) << s << ' ' << offset_m;
      const double across_m = std::abs(offset_m - drive.ground().road().centre_offset_m());
      const bool at_kerb = std::abs(across_m - drive.ground().road().half_width_m()) < 0.05;
      ASSERT_NEAR(hit->range_m, 5.0, at_kerb ? 0.15 : 0.06) << s << ' ' << offset_m;
    }
  }
}

}  // namespace
}  // namespace landfix::tools::simulator
