#include "platform/place_search.hpp"

#include <random>

#include <gtest/gtest.h>

#include "ndt/map_image.hpp"
#include "ndt/random_world.hpp"

namespace landfix::platform {
namespace {

constexpr std::int64_t kSweep_ns = 100'000'000;
constexpr std::uint64_t kSweepsASearch = ndt::PlaceFinder::kSweepsASearch;

/// A vehicle that stands in a town.
class StandsInATown : public testing::Test {
 protected:
  void SetUp() override { search_.prepare(); }

  /// A sweep more; what was known before it.
  std::optional<ndt::Found> pass() {
    const auto answer = search_.answer();
    search_.put({.stamp_utc_ns = ++sweeps_ * kSweep_ns, .area = area_}, scan_m_);
    return answer;
  }

  std::vector<Eigen::Vector3d> town_m_ = ndt::test::random_town(1);
  ndt::MapImage image_ = ndt::test::build_map(town_m_, 1.0);
  std::mt19937_64 random_{2};
  ndt::Pose truth_ = ndt::test::random_stand(random_, town_m_);
  std::vector<Eigen::Vector3f> scan_m_ = ndt::test::scan_from(town_m_, truth_);
  PlaceSearch search_{ndt::VoxelMap(image_.bytes())};
  std::int64_t sweeps_ = 0;
  std::optional<ndt::PoseGuess> area_;
};

TEST_F(StandsInATown, IsFoundWhenTheTimeIsUpHoweverSoonItWas) {
  for (std::uint64_t sweep = 0; sweep < kSweepsASearch; ++sweep) {
    EXPECT_FALSE(pass()) << sweep;
    EXPECT_TRUE(search_.work());
    EXPECT_FALSE(search_.work()) << "one sweep was put in";
  }
  const auto found = pass();
  ASSERT_TRUE(found);
  EXPECT_LT((found->at.pose.translation() - truth_.translation()).norm(), 0.1);
  EXPECT_EQ(found->at.stamp_utc_ns, static_cast<std::int64_t>(kSweepsASearch) * kSweep_ns);
  EXPECT_LT(found->velocity.norm(), 0.5);
  EXPECT_EQ(search_.late(), 0U);
}

TEST_F(StandsInATown, AnAnswerThatIsLateIsCountedAndComesWhenItIsThere) {
  for (std::uint64_t sweep = 0; sweep < kSweepsASearch; ++sweep) EXPECT_FALSE(pass());
  EXPECT_EQ(search_.late(), 0U);
  EXPECT_FALSE(pass());
  EXPECT_EQ(search_.late(), 1U);
  while (search_.work()) continue;  // it begins with the newest
  for (std::uint64_t sweep = 1; sweep < kSweepsASearch; ++sweep) {
    EXPECT_FALSE(pass());
    EXPECT_TRUE(search_.work());
  }
  EXPECT_TRUE(pass());
  EXPECT_EQ(search_.late(), 1U);
}

TEST_F(StandsInATown, SweepsWithoutRoomAreCounted) {
  for (int sweep = 0; sweep < 60; ++sweep) EXPECT_FALSE(pass());
  EXPECT_GT(search_.late(), 60 - 32U);
  EXPECT_TRUE(search_.work());
  EXPECT_FALSE(search_.work()) << "only the newest was of use";
  EXPECT_FALSE(pass()) << "what is known is of long ago";
  std::optional<ndt::Found> found;
  for (std::uint64_t sweep = 0; sweep < 3 * kSweepsASearch && !found; ++sweep) {
    while (search_.work()) continue;
    found = pass();
  }
  EXPECT_TRUE(found);
}

TEST_F(StandsInATown, BeginsAnewAfterTheEnd) {
  for (std::uint64_t sweep = 0; sweep <= kSweepsASearch; ++sweep) {
    (void)pass();
    (void)search_.work();
  }
  search_.end();
  for (std::uint64_t sweep = 0; sweep < kSweepsASearch; ++sweep) {
    EXPECT_FALSE(pass()) << "what was known is of long ago";
    (void)search_.work();
  }
  EXPECT_TRUE(pass());
}

TEST_F(StandsInATown, IsFoundInItsAreaAlone) {
  area_ = {.position_m = {5000.0, 5000.0}, .within_m = 50.0};
  for (std::uint64_t sweep = 0; sweep < 2 * kSweepsASearch; ++sweep) {
    EXPECT_FALSE(pass());
    (void)search_.work();
  }
  area_ = {.position_m = truth_.translation().head<2>() + Eigen::Vector2d(10.0, 0.0), .within_m = 20.0};
  for (std::uint64_t sweep = 0; sweep < kSweepsASearch; ++sweep) {
    EXPECT_FALSE(pass());
    (void)search_.work();
  }
  EXPECT_TRUE(pass());
}

TEST_F(StandsInATown, SeesNothing) {
  scan_m_.clear();
  for (std::uint64_t sweep = 0; sweep < 2 * kSweepsASearch; ++sweep) {
    EXPECT_FALSE(pass());
    (void)search_.work();
  }
}

}  // namespace
}  // namespace landfix::platform
