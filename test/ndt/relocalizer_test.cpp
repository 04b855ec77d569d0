#include "ndt/relocalizer.hpp"

#include <random>

#include <gtest/gtest.h>

#include "ndt/random_world.hpp"

namespace landfix::ndt::test {
namespace {

/// The map of some points, and what is needed to find oneself in it.
struct Known {
  explicit Known(const std::vector<Eigen::Vector3d>& points_m) : image(build_map(points_m, 1.0)) {}
  MapImage image;
  VoxelMap map{image.bytes()};
  PlanView plan{map};
  Relocalizer relocalizer{plan};
};

void expect_near(const Pose& found, const Pose& truth) {
  EXPECT_LT((found.translation() - truth.translation()).norm(), 0.1);
  EXPECT_LT(angle_between(found, truth), 0.5 * kRadians_per_deg);
}

TEST(Relocalizer, FindsItselfInATownWithoutAGuess) {
  const auto town_m = random_town(1);
  Known known(town_m);
  std::mt19937_64 random(2);
  for (int i = 0; i < 10; ++i) {
    const Pose truth = random_stand(random, town_m);
    const Location location = known.relocalizer.locate(known.map, scan_from(town_m, truth));
    ASSERT_FALSE(location.candidates.empty());
    expect_near(location.candidates[0].match.pose, truth);
    EXPECT_TRUE(location.sure) << location.confidence;
    for (std::size_t k = 1; k < location.candidates.size(); ++k)
      EXPECT_LE(location.candidates[k].match.explained(), location.candidates[k - 1].match.explained());
  }
}

TEST(Relocalizer, FindsItselfOnAHillAndAtUtmCoordinates) {
  constexpr double kRise = 0.08;
  const Eigen::Vector3d origin_m(392'000.0, 3'951'000.0, 120.0);
  const auto at_origin_m = random_town(3, Eigen::Vector3d::Zero(), kRise);
  const auto town_m = random_town(3, origin_m, kRise);
  Known known(town_m);
  std::mt19937_64 random(4);
  for (int i = 0; i < 5; ++i) {
    Pose truth = random_stand(random, at_origin_m, kRise);
    truth.translation() += origin_m;
    const Location location = known.relocalizer.locate(known.map, scan_from(town_m, truth));
    ASSERT_FALSE(location.candidates.empty());
    expect_near(location.candidates[0].match.pose, truth);
    EXPECT_TRUE(location.sure) << location.confidence;
  }
}

TEST(Relocalizer, IsNotSureInAnotherTown) {
  const auto elsewhere_m = random_town(7);
  Known known(random_town(8));
  std::mt19937_64 random(9);
  for (int i = 0; i < 5; ++i) {
    const Location location =
        known.relocalizer.locate(known.map, scan_from(elsewhere_m, random_stand(random, elsewhere_m)));
    EXPECT_FALSE(location.sure) << location.confidence;
    EXPECT_LT(location.confidence, 0.5);
  }
}

TEST(Relocalizer, IsNotSureWhereTwoPlacesLookAlike) {
  const Eigen::Vector3d between_m(170.0, 0.0, 0.0);
  auto world_m = random_town(10);
  const auto once_m = world_m;
  for (const Eigen::Vector3d& point_m : once_m) world_m.emplace_back(point_m + between_m);
  Known known(world_m);
  std::mt19937_64 random(11);
  const Pose truth = random_stand(random, once_m);
  const auto scan_m = scan_from(once_m, truth);
  const Location location = known.relocalizer.locate(known.map, scan_m);
  ASSERT_GE(location.candidates.size(), 2U);
  EXPECT_FALSE(location.sure) << location.confidence;
  EXPECT_NEAR(
      (location.candidates[0].match.pose.translation() - location.candidates[1].match.pose.translation())
          .norm(),
      between_m.norm(), 0.2);
  // What tells one from the other makes it sure.
  const Location of_area = known.relocalizer.locate(
      known.map, scan_m, PoseGuess{.position_m = truth.translation().head<2>(), .within_m = 20.0});
  ASSERT_FALSE(of_area.candidates.empty());
  expect_near(of_area.candidates[0].match.pose, truth);
  EXPECT_TRUE(of_area.sure) << of_area.confidence;
}

TEST(Relocalizer, HasNothingToSayOfNothing) {
  const auto town_m = random_town(12);
  Known known(town_m);
  EXPECT_TRUE(known.relocalizer.locate(known.map, {}).candidates.empty());
  std::vector<Eigen::Vector3f> plain_m;  // ground alone
  for (float x_m = -40.0F; x_m < 40.0F; x_m += 2.0F) {
    for (float y_m = -40.0F; y_m < 40.0F; y_m += 2.0F) plain_m.emplace_back(x_m, y_m, 0.0F);
  }
  EXPECT_FALSE(known.relocalizer.locate(known.map, plain_m).sure);
  Known nowhere(std::vector<Eigen::Vector3d>(random_yard(1, 5000)));
  EXPECT_FALSE(nowhere.relocalizer.locate(nowhere.map, plain_m).sure);
}

TEST(Relocalizer, IsNotSureWhenItHadNoTime) {
  const auto town_m = random_town(13);
  Known known(town_m);
  std::mt19937_64 random(14);
  const Location location =
      known.relocalizer.locate(known.map, scan_from(town_m, random_stand(random, town_m)), std::nullopt,
                               {.now_ns = []() noexcept -> std::int64_t { return 1; }});
  EXPECT_FALSE(location.sure);
  EXPECT_FALSE(location.complete);
}

}  // namespace
}  // namespace landfix::ndt::test
