#include "ndt/plan_search.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "ndt/random_world.hpp"

namespace landfix::ndt::test {
namespace {

class PlanSearchInATown : public testing::Test {
 protected:
  std::vector<Eigen::Vector3d> town_m_ = random_town(1);
  MapImage image_ = build_map(town_m_, 1.0);
  VoxelMap map_{image_.bytes()};
  PlanView plan_{map_};
  PlanSearch search_{plan_};
  PlanPoints points_{plan_.cell_m()};

  /// Every place, every heading.
  [[nodiscard]] int best_score() const {
    int best = 0;
    const std::uint8_t* const weights = plan_.level(0).data();
    for (std::int32_t heading = 0; heading < PlanSearch::kHeadings; ++heading) {
      const Eigen::Rotation2Df turn(
          static_cast<float>(2.0 * std::numbers::pi * heading / PlanSearch::kHeadings));
      std::vector<std::int32_t> offsets;
      for (const Eigen::Vector2f& point : points_.cells()) {
        const Eigen::Vector2f cell = turn * point;
        offsets.push_back(static_cast<std::int32_t>(std::floor(cell.y())) * plan_.width() +
                          static_cast<std::int32_t>(std::floor(cell.x())));
      }
      const std::int32_t* const first = offsets.data();
      const std::int32_t* const last = first + offsets.size();
      for (std::int32_t y = 0; y < plan_.height(); ++y) {
        for (std::int32_t x = 0; x < plan_.width(); ++x) {
          if (!plan_.has_ground(x, y)) continue;
          // By pointers: under sanitizers anything else takes minutes.
          const std::uint8_t* const here = weights + (y * plan_.width() + x);
          int score = 0;
          for (const std::int32_t* offset = first; offset != last; ++offset) score += here[*offset];
          best = std::max(best, score);
        }
      }
    }
    return best;
  }
};

TEST_F(PlanSearchInATown, FindsWhatTryingEverythingFinds) {
  std::mt19937_64 random(2);
  points_.take(scan_from(town_m_, random_stand(random, town_m_)));
  ASSERT_EQ(points_.cells().size(), PlanPoints::kMost);
  const auto places = search_.find(points_, std::nullopt, 8, {});
  ASSERT_FALSE(places.empty());
  EXPECT_EQ(places[0].score, best_score());
  EXPECT_TRUE(search_.was_complete());
}

TEST_F(PlanSearchInATown, PlacesAreApartAndTheBestFirst) {
  std::mt19937_64 random(3);
  points_.take(scan_from(town_m_, random_stand(random, town_m_)));
  const auto places = search_.find(points_, std::nullopt, PlanSearch::kMostPlaces, {});
  ASSERT_EQ(places.size(), PlanSearch::kMostPlaces);
  for (std::size_t i = 1; i < places.size(); ++i) {
    EXPECT_GE(places[i - 1].score, places[i].score);
    for (std::size_t k = 0; k < i; ++k) {
      const double apart_m = (places[i].position_m - places[k].position_m).norm();
      const double turned_rad = std::remainder(places[i].yaw_rad - places[k].yaw_rad, 2.0 * std::numbers::pi);
      EXPECT_TRUE(apart_m > 1.9 || std::abs(turned_rad) > 0.15);
    }
  }
}

TEST_F(PlanSearchInATown, KeepsToTheAreaAndTheHeading) {
  std::mt19937_64 random(4);
  const Pose pose = random_stand(random, town_m_);
  points_.take(scan_from(town_m_, pose));
  PoseGuess area{.position_m = pose.translation().head<2>() + Eigen::Vector2d(8.0, -6.0), .within_m = 12.0};
  for (const PlanPlace& place : search_.find(points_, area, 16, {}))
    EXPECT_LT((place.position_m - area.position_m).norm(), area.within_m + 10.0);
  EXPECT_LT((search_.find(points_, area, 16, {})[0].position_m - pose.translation().head<2>()).norm(), 1.5);
  area.yaw_rad = to_roll_pitch_yaw(pose.linear()).yaw_rad + 1.0;
  for (const PlanPlace& place : search_.find(points_, area, 16, {}))
    EXPECT_LT(std::abs(std::remainder(place.yaw_rad - *area.yaw_rad, 2.0 * std::numbers::pi)), 0.13);
  area.position_m = {1e6, 0.0};
  EXPECT_TRUE(search_.find(points_, area, 16, {}).empty());
}

TEST_F(PlanSearchInATown, EndsAtTheDeadlineAndSaysSo) {
  std::mt19937_64 random(5);
  points_.take(scan_from(town_m_, random_stand(random, town_m_)));
  EXPECT_TRUE(search_.find(points_, std::nullopt, 8, {.now_ns = []() noexcept -> std::int64_t { return 1; }})
                  .empty());
  EXPECT_FALSE(search_.was_complete());
}

}  // namespace
}  // namespace landfix::ndt::test
