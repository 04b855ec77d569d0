#include "ndt/matcher.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "ndt/covariance.hpp"
#include "ndt/objective.hpp"

namespace landfix::ndt {
namespace {

struct Estimate {
  Pose pose;
  Objective objective;
};

[[nodiscard]] Pose moved(const Pose& pose, const Twist& step) noexcept {
  Pose result = pose;
  result.linear() = rotation_exp(step.tail<3>()) * pose.linear();
  result.translation() += step.head<3>();
  return result;
}

/// The step of Newton's method with as much of the curvature as leaves the Hessian positive definite, damped
/// after Levenberg and Marquardt.
[[nodiscard]] Twist newton_step(const Objective& objective, double damping) noexcept {
  constexpr double kDefinite = 1e-3;  // of the definite part's diagonal
  const Twist scale = objective.definite.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  const Matrix6 definite = scale.asDiagonal() * objective.definite * scale.asDiagonal();
  const Matrix6 curvature = scale.asDiagonal() * objective.curvature * scale.asDiagonal();
  const Twist gradient = scale.cwiseProduct(objective.gradient);
  Eigen::LDLT<Matrix6> ldlt;
  for (const double share : {1.0, 0.75, 0.5, 0.25, 0.0}) {
    ldlt.compute(definite - share * curvature + damping * Matrix6::Identity());
    if (ldlt.info() == Eigen::Success && ldlt.vectorD().minCoeff() > kDefinite) break;
  }
  // Directions that nothing constrains have a pivot near 0: LDLT's solve leaves them where they are.
  return scale.cwiseProduct(ldlt.solve(gradient).eval());
}

[[nodiscard]] Twist limited(const Twist& step, const MatcherSettings& settings) noexcept {
  const double factor = std::min({1.0, settings.step_limit_m / std::max(step.head<3>().norm(), 1e-12),
                                  settings.step_limit_rad / std::max(step.tail<3>().norm(), 1e-12)});
  return factor * step;
}

/// Whether the sharp optimum may replace the wide one it started from. The sharp score has many more maxima:
/// with few points, a direction that nothing holds, or a large move it is likely to be another one.
[[nodiscard]] bool is_trustworthy(const Estimate& wide, const Estimate& sharp, std::size_t points_matched,
                                  double resolution_m) noexcept {
  constexpr std::size_t kEnoughPoints = 200;
  constexpr double kHeld = 1e-4;  // smallest pivot of the Hessian scaled to a unit diagonal
  constexpr double kSmallMove = 0.25;
  constexpr double kSmallTurn_rad = 0.02;
  const Twist scale = sharp.objective.definite.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Matrix6> ldlt(scale.asDiagonal() * sharp.objective.definite * scale.asDiagonal());
  return points_matched >= kEnoughPoints && ldlt.vectorD().minCoeff() > kHeld &&
         (sharp.pose.translation() - wide.pose.translation()).norm() < kSmallMove * resolution_m &&
         angle_between(sharp.pose, wide.pose) < kSmallTurn_rad;
}

/// How a search looks at the map, and when it may stop.
struct Phase {
  Covariance covariance{};
  double narrowness = 1.0;   ///< factor of d2: below 1, voxels pull from farther away
  double converged_m = 0.0;  ///< a step shorter than both ends it
  double converged_rad = 0.0;
};

/// From far away: few points, and distributions so wide that the nearest optimum
/// is the right one from twice as far. Where it ends is near enough for the other phases.
constexpr Phase kCoarse{
    .covariance = Covariance::wide, .narrowness = 0.05, .converged_m = 0.02, .converged_rad = 2e-3};

/// Of a search that another one goes on from.
constexpr double kLeadingTolerance = 30.0;

class Search {
 public:
  Search(const VoxelMap& map, const MatcherSettings& settings, const ScoreConstants& constants) noexcept
      : map_(map), settings_(settings), constants_(constants) {}

  [[nodiscard]] Estimate evaluate_at(const Pose& pose, PairGroups& groups, const Phase& phase) noexcept {
    ++iterations_;
    const ScoreConstants constants{.d1 = constants_.d1, .d2 = phase.narrowness * constants_.d2};
    return {pose, evaluate(map_, groups, pose, phase.covariance, constants)};
  }

  /// Climbs from `best` until a step is negligible (true) or the iterations are spent (false).
  [[nodiscard]] bool climb(Estimate& best, PairGroups& groups, const Phase& phase) noexcept {
    constexpr double kMinDamping = 1e-5;
    constexpr double kMaxDamping = 1e4;
    double damping = kMinDamping;
    while (iterations_ < settings_.max_iterations) {
      const Twist step = limited(newton_step(best.objective, damping), settings_);
      if (step.head<3>().norm() < phase.converged_m && step.tail<3>().norm() < phase.converged_rad)
        return true;
      const Estimate next = evaluate_at(moved(best.pose, step), groups, phase);
      if (next.objective.score >= best.objective.score) {
        best = next;
        damping = std::max(0.1 * damping, kMinDamping);
      } else {
        damping = std::max(10.0 * damping, 0.1);
        if (damping > kMaxDamping) return true;
      }
    }
    return false;
  }

  [[nodiscard]] int iterations() const noexcept { return iterations_; }

 private:
  const VoxelMap& map_;
  const MatcherSettings& settings_;
  ScoreConstants constants_;
  int iterations_ = 0;
};

}  // namespace

MatchResult Matcher::match(const VoxelMap& map, std::span<const Eigen::Vector3f> points_m,
                           const Pose& guess) noexcept {
  MatchResult result;
  const ScoreConstants constants = score_constants(settings_.outlier_ratio, map.resolution_m());
  const Phase sharp_phase{.covariance = Covariance::sharp,
                          .converged_m = settings_.converged_m,
                          .converged_rad = settings_.converged_rad};
  Phase wide_phase = sharp_phase;
  wide_phase.covariance = Covariance::wide;
  // What only leads to the sharp optimum need not be exact.
  Phase leading_phase = wide_phase;
  leading_phase.converged_m *= kLeadingTolerance;
  leading_phase.converged_rad *= kLeadingTolerance;
  result.points = points_m.size();
  result.best_likelihood = constants.d1;
  Search search(map, settings_, constants);

  Pose start = guess;
  if (settings_.coarse_points != 0) {
    const std::size_t stride = std::max<std::size_t>(1, points_m.size() / settings_.coarse_points);
    coarse_groups_.assign(points_m, stride);
    Estimate coarse = search.evaluate_at(guess, coarse_groups_, kCoarse);
    if (coarse.objective.pairs != 0) static_cast<void>(search.climb(coarse, coarse_groups_, kCoarse));
    start = coarse.pose;
    result.pairs_dropped = coarse_groups_.dropped_pairs();
  }

  groups_.assign(points_m, 1);
  Estimate best = search.evaluate_at(start, groups_, wide_phase);
  result.converged = best.objective.pairs != 0 &&
                     search.climb(best, groups_, settings_.sharpen ? leading_phase : wide_phase);
  groups_.update(map, best.pose, Covariance::wide);
  const PointScores points = score_points(map, groups_, best.pose, constants);
  result.score = best.objective.score;
  if (settings_.sharpen && result.converged) {
    Estimate sharp = search.evaluate_at(best.pose, groups_, sharp_phase);
    result.sharpened = search.climb(sharp, groups_, sharp_phase) &&
                       is_trustworthy(best, sharp, points.points_matched, map.resolution_m());
    if (result.sharpened) {
      best = sharp;
    } else {
      result.converged = search.climb(best, groups_, wide_phase);
    }
  }
  result.pose = best.pose;
  result.pairs_dropped += groups_.dropped_pairs();
  result.covariance = pose_covariance(best.objective, best.pose);
  result.iterations = search.iterations();
  result.points_matched = points.points_matched;
  if (!points_m.empty())
    result.transformation_probability = result.score / static_cast<double>(points_m.size());
  if (points.points_matched != 0) {
    result.nearest_voxel_likelihood = points.best_sum / static_cast<double>(points.points_matched);
  }
  return result;
}

}  // namespace landfix::ndt
