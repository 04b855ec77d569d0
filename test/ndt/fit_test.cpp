#include "ndt/fit.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace landfix::ndt::test {
namespace {

/// Of a scan that the map explains.
[[nodiscard]] MatchResult good_match() {
  MatchResult match{.nearest_voxel_likelihood = 2.0,
                    .no_ground_nearest_voxel_likelihood = 1.8,
                    .best_likelihood = 2.2,
                    .points = 1000,
                    .points_matched = 900,
                    .no_ground_points = 500,
                    .no_ground_points_matched = 450,
                    .converged = true};
  match.covariance = 1e-4 * Matrix6::Identity();
  return match;
}

/// What becomes of it by one change.
template <class Change>
[[nodiscard]] Fit judge_with(Change change) {
  MatchResult match = good_match();
  change(match);
  return judge(match, {});
}

TEST(Judge, IsGoodWhereAllIs) { EXPECT_EQ(judge(good_match(), {}), Fit::good); }

TEST(Judge, BelievesNothingThatFitsByChance) {
  EXPECT_EQ(judge_with([](MatchResult& match) { match.converged = false; }), Fit::none);
  EXPECT_EQ(judge_with([](MatchResult& match) { match.nearest_voxel_likelihood = 0.4; }), Fit::none);
  EXPECT_EQ(judge_with([](MatchResult& match) {
              match.nearest_voxel_likelihood = std::numeric_limits<double>::quiet_NaN();
            }),
            Fit::none);
  EXPECT_EQ(judge_with([](MatchResult& match) { match.points = match.points_matched = 49; }), Fit::none);
  EXPECT_EQ(judge_with([](MatchResult& match) { match.no_ground_points_matched = 50; }), Fit::none)
      << "the ground alone fits anywhere";
}

TEST(Judge, IsWeakWhereLittleSpeaksForIt) {
  EXPECT_EQ(judge_with([](MatchResult& match) { match.nearest_voxel_likelihood = 1.0; }), Fit::weak);
  EXPECT_EQ(judge_with([](MatchResult& match) { match.points_matched = 300; }), Fit::weak);
  EXPECT_EQ(judge_with([](MatchResult& match) { match.points = match.points_matched = 99; }), Fit::weak);
  EXPECT_EQ(judge_with([](MatchResult& match) { match.no_ground_points_matched = 250; }), Fit::weak);
  EXPECT_EQ(judge_with([](MatchResult& match) { match.covariance(1, 1) = 0.01; }), Fit::weak);
}

TEST(Judge, TakesTheGroundWhereNothingStands) {
  EXPECT_EQ(judge_with([](MatchResult& match) {
              match.no_ground_points = match.no_ground_points_matched = 0;
              match.no_ground_nearest_voxel_likelihood = 0.0;
            }),
            Fit::good);
}

}  // namespace
}  // namespace landfix::ndt::test
