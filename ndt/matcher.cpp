#include "ndt/matcher.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "ndt/assessment.hpp"
#include "ndt/newton_search.hpp"
#include "ndt/objective.hpp"

namespace landfix::ndt {
namespace {

/// Whether the sharp optimum may stand. The sharp score has many maxima more than the wide one: with few
/// points, a direction that nothing holds, or far from the wide optimum it is likely to be a wrong one.
[[nodiscard]] bool is_trustworthy(const Estimate& sharp, const Pose& wide, std::size_t points_matched,
                                  double resolution_m) noexcept {
  constexpr std::size_t kEnoughPoints = 200;
  constexpr double kHeld = 1e-4;  // smallest pivot of the Hessian scaled to a unit diagonal
  constexpr double kSmallMove = 0.25;
  constexpr double kSmallTurn_rad = 0.02;
  const Twist scale = sharp.objective.definite.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Matrix6> ldlt(scale.asDiagonal() * sharp.objective.definite * scale.asDiagonal());
  return sharp.converged && points_matched >= kEnoughPoints && ldlt.vectorD().minCoeff() > kHeld &&
         (sharp.pose.translation() - wide.translation()).norm() < kSmallMove * resolution_m &&
         angle_between(sharp.pose, wide) < kSmallTurn_rad;
}

/// The phases of a search, from far away to the last digit. Only the last need be exact: what leads to it
/// looks at few points, in less time.
struct Phases {
  explicit Phases(const MatcherSettings& settings) noexcept
      : wide{.covariance = Covariance::wide,
             .tolerance_m = settings.converged_m,
             .tolerance_rad = settings.converged_rad},
        sharp(wide),
        leading_wide(wide),
        leading_sharp(wide) {
    constexpr double kLoose = 100.0;
    sharp.covariance = leading_sharp.covariance = Covariance::sharp;
    for (Phase* const phase : {&leading_wide, &leading_sharp}) {
      phase->tolerance_m *= kLoose;
      phase->tolerance_rad *= kLoose;
      phase->max_iterations = 6;
    }
  }

  /// Distributions so wide that the nearest optimum is the right one from twice as far.
  Phase coarse{.covariance = Covariance::wide,
               .narrowness = 0.05,
               .tolerance_m = 0.02,
               .tolerance_rad = 2e-3,
               .max_iterations = 20};
  Phase wide;
  Phase sharp;
  Phase leading_wide;
  Phase leading_sharp;
};

/// Every how many-th point makes about so many.
[[nodiscard]] std::size_t stride_for(std::size_t points, std::size_t wanted) noexcept {
  return std::max<std::size_t>(1, points / wanted);
}

}  // namespace

MatchResult Matcher::match(const VoxelMap& map, std::span<const Eigen::Vector3f> points_m, const Pose& guess,
                           std::optional<double> guess_sigma_m) noexcept {
  MatchResult result;
  const ScoreConstants constants = score_constants(settings_.outlier_ratio, map.resolution_m());
  result.points = points_m.size();
  result.best_likelihood = constants.d1;
  const Phases phases(settings_);
  NewtonSearch search(map, constants, {settings_.step_limit_m, settings_.step_limit_rad},
                      settings_.max_iterations);

  Pose wide = guess;
  Pose sharp = guess;
  if (settings_.few_points != 0) {
    coarse_groups_.assign(points_m, stride_for(points_m.size(), settings_.few_points));
    leading_groups_.assign(points_m, stride_for(points_m.size(), 2 * settings_.few_points));
    wide = search.climb(guess, coarse_groups_, phases.coarse).pose;
    wide = search.climb(wide, leading_groups_, phases.leading_wide).pose;
    const Estimate leading = search.climb(wide, leading_groups_, phases.leading_sharp);
    sharp = leading.converged ? leading.pose : wide;
    result.pairs_dropped = coarse_groups_.dropped_pairs() + leading_groups_.dropped_pairs();
  }

  groups_.assign(points_m, 1);
  Estimate best;
  PointScores points;
  const auto score_wide = [&] {
    result.score = evaluate(map, groups_, best.pose, Covariance::wide, constants).score;
    points = score_points(map, groups_, best.pose, constants);
  };
  if (settings_.sharpen) {
    best = search.climb(sharp, groups_, phases.sharp);
    score_wide();
    result.sharpened = is_trustworthy(best, wide, points.all.points, map.resolution_m());
  }
  if (!result.sharpened) {
    best = search.climb(wide, groups_, phases.wide);
    score_wide();
  }
  result.converged = best.converged;
  result.pose = best.pose;
  if (best.objective.pairs != 0) {
    const Assessment assessment =
        assess(map, groups_, best.pose, result.sharpened ? Covariance::sharp : Covariance::wide, constants,
               {.pose = guess, .sigma_m = guess_sigma_m.value_or(map.resolution_m())});
    result.pose = assessment.pose;
    result.covariance = assessment.covariance;
    result.weak = assessment.weak;
  }
  result.pairs_dropped += groups_.dropped_pairs();
  result.iterations = search.iterations();
  result.points_matched = points.all.points;
  if (!points_m.empty())
    result.transformation_probability = result.score / static_cast<double>(points_m.size());
  result.nearest_voxel_likelihood = points.all.mean();
  result.no_ground_points_matched = points.no_ground.points;
  result.no_ground_nearest_voxel_likelihood = points.no_ground.mean();
  return result;
}

}  // namespace landfix::ndt
