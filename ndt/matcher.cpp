#include "ndt/matcher.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "ndt/assessment.hpp"
#include "ndt/newton_search.hpp"
#include "ndt/objective.hpp"
#include "ndt/scan_information.hpp"
#include "ndt/score.hpp"

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
    constexpr double kLoose = 20.0;
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

/// What a search ended with, and how all of the points see it.
struct Ending {
  Estimate estimate;
  ScanInformation sharp;
  PointScores wide_scores;
};

[[nodiscard]] std::size_t count_standing(std::span<const Eigen::Vector3f> points_m) noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(points_m, [](const Eigen::Vector3f& point_m) {
    return point_m.z() > static_cast<float>(kAboveGround_m);
  }));
}

[[nodiscard]] Ending look_around(const VoxelMap& map, PairGroups& groups, const Estimate& estimate,
                                 const ScoreConstants& constants) noexcept {
  return {.estimate = estimate,
          .sharp = gather_information(map, groups, estimate.pose, Covariance::sharp, constants),
          .wide_scores = score_points(map, groups, estimate.pose, Covariance::wide, constants)};
}

}  // namespace

MatchResult Matcher::match(const VoxelMap& map, std::span<const Eigen::Vector3f> points_m, const Pose& guess,
                           std::optional<double> guess_sigma_m, const Deadline& deadline) noexcept {
  MatchResult result;
  const ScoreConstants constants = score_constants(settings_.outlier_ratio, map.resolution_m());
  result.points = points_m.size();
  result.best_likelihood = constants.d1;
  const Phases phases(settings_);
  NewtonSearch search(map, constants, {settings_.step_limit_m, settings_.step_limit_rad},
                      settings_.max_iterations, deadline);

  Pose wide = guess;
  Pose sharp = guess;
  if (settings_.few_points != 0) {
    coarse_groups_.assign(points_m, settings_.few_points);
    leading_groups_.assign(points_m, 2 * settings_.few_points);
    wide = search.climb(guess, coarse_groups_, phases.coarse).pose;
    wide = search.climb(wide, leading_groups_, phases.leading_wide).pose;
    const Estimate leading = search.climb(wide, leading_groups_, phases.leading_sharp);
    sharp = leading.converged ? leading.pose : wide;
    result.pairs_dropped = coarse_groups_.dropped_pairs() + leading_groups_.dropped_pairs();
  }

  groups_.assign(points_m);
  const auto climb = [&](const Pose& start, const Phase& phase) {
    return look_around(map, groups_, search.climb(start, groups_, phase), constants);
  };
  Ending end;
  if (settings_.sharpen) {
    end = climb(sharp, phases.sharp);
    result.sharpened = is_trustworthy(end.estimate, wide, end.wide_scores.all.points, map.resolution_m());
  }
  if (!result.sharpened) end = climb(wide, phases.wide);

  result.converged = end.estimate.converged && !search.was_cut_short();
  result.pose = end.estimate.pose;
  if (end.estimate.objective.pairs != 0) {
    const Assessment assessment =
        assess(map, groups_, end.estimate.pose, result.sharpened ? Covariance::sharp : Covariance::wide,
               end.sharp, constants, {.pose = guess, .sigma_m = guess_sigma_m.value_or(map.resolution_m())});
    result.pose = assessment.pose;
    result.covariance = assessment.covariance;
    result.weak = assessment.weak;
  }
  result.pairs_dropped += groups_.dropped_pairs();
  result.iterations = search.iterations();
  result.out_of_time = search.was_cut_short();
  const PointScores& scores = end.wide_scores;
  result.score = scores.sum;
  if (!points_m.empty())
    result.transformation_probability = result.score / static_cast<double>(points_m.size());
  result.points_matched = scores.all.points;
  result.nearest_voxel_likelihood = scores.all.mean();
  result.no_ground_points = count_standing(points_m);
  result.no_ground_points_matched = scores.no_ground.points;
  result.no_ground_nearest_voxel_likelihood = scores.no_ground.mean();
  return result;
}

}  // namespace landfix::ndt
