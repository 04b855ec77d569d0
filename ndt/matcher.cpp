#include "ndt/matcher.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

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

/// The covariance of (v, w) turned into one of x y z roll pitch yaw.
[[nodiscard]] Matrix6 to_roll_pitch_yaw_covariance(const Matrix6& covariance, const Pose& pose) noexcept {
  const RollPitchYaw angles = to_roll_pitch_yaw(pose.linear());
  const double cy = std::cos(angles.yaw_rad);
  const double sy = std::sin(angles.yaw_rad);
  const double cp = std::max(std::cos(angles.pitch_rad), 1e-6);
  const double tp = std::sin(angles.pitch_rad) / cp;
  // Rates of roll, pitch and yaw of a rotation rate in map axes, R = Rz Ry Rx.
  Matrix6 jacobian = Matrix6::Identity();
  jacobian.bottomRightCorner<3, 3>() << cy / cp, sy / cp, 0.0,  //
      -sy, cy, 0.0,                                             //
      cy * tp, sy * tp, 1.0;
  return jacobian * covariance * jacobian.transpose();
}

/// Laplace's approximation: the inverse Hessian at the maximum.
[[nodiscard]] Matrix6 laplace_covariance(const Objective& objective) noexcept {
  constexpr double kUnknown = 1e-6;  // information that stands for none: 1000 m, 1000 rad
  const Eigen::LDLT<Matrix6> ldlt(objective.definite + kUnknown * Matrix6::Identity());
  // By columns: Eigen's solver of several at once asks for cache sizes behind a lock.
  Matrix6 inverse;
  for (int i = 0; i < 6; ++i) inverse.col(i) = ldlt.solve(Twist::Unit(i).eval());
  return inverse;
}

/// Whether the sharp optimum may replace the wide one it started from. The sharp score has many more maxima:
/// with few points, a direction that nothing holds, or a large move it is likely to be another one.
[[nodiscard]] bool is_trustworthy(const Estimate& wide, const Estimate& sharp, double resolution_m) noexcept {
  constexpr std::size_t kEnoughPoints = 200;
  constexpr double kHeld = 1e-4;  // smallest pivot of the Hessian scaled to a unit diagonal
  constexpr double kSmallMove = 0.25;
  constexpr double kSmallTurn_rad = 0.02;
  const Twist scale = sharp.objective.definite.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Matrix6> ldlt(scale.asDiagonal() * sharp.objective.definite * scale.asDiagonal());
  return sharp.objective.points_matched >= kEnoughPoints && ldlt.vectorD().minCoeff() > kHeld &&
         (sharp.pose.translation() - wide.pose.translation()).norm() < kSmallMove * resolution_m &&
         angle_between(sharp.pose, wide.pose) < kSmallTurn_rad;
}

class Search {
 public:
  Search(const VoxelMap& map, std::span<const Eigen::Vector3f> points_m, const MatcherSettings& settings,
         const ScoreConstants& constants) noexcept
      : map_(map), points_m_(points_m), settings_(settings), constants_(constants) {}

  [[nodiscard]] Estimate evaluate_at(const Pose& pose, Covariance covariance) noexcept {
    ++iterations_;
    return {pose, evaluate(map_, points_m_, pose, covariance, constants_)};
  }

  /// Climbs from `best` until a step is negligible (true) or the iterations are spent (false).
  [[nodiscard]] bool climb(Estimate& best, Covariance covariance) noexcept {
    constexpr double kMinDamping = 1e-5;
    constexpr double kMaxDamping = 1e4;
    double damping = kMinDamping;
    while (iterations_ < settings_.max_iterations) {
      const Twist step = limited(newton_step(best.objective, damping), settings_);
      if (is_negligible(step)) return true;
      const Estimate next = evaluate_at(moved(best.pose, step), covariance);
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
  [[nodiscard]] bool is_negligible(const Twist& step) const noexcept {
    return step.head<3>().norm() < settings_.converged_m && step.tail<3>().norm() < settings_.converged_rad;
  }

  const VoxelMap& map_;
  std::span<const Eigen::Vector3f> points_m_;
  const MatcherSettings& settings_;
  ScoreConstants constants_;
  int iterations_ = 0;
};

}  // namespace

MatchResult Matcher::match(const VoxelMap& map, std::span<const Eigen::Vector3f> points_m,
                           const Pose& guess) const noexcept {
  MatchResult result;
  const ScoreConstants constants = score_constants(settings_.outlier_ratio, map.resolution_m());
  result.points = points_m.size();
  result.best_likelihood = constants.d1;
  Search search(map, points_m, settings_, constants);
  Estimate wide = search.evaluate_at(guess, Covariance::wide);
  result.converged = wide.objective.pairs != 0 && search.climb(wide, Covariance::wide);
  Estimate final = wide;
  if (settings_.sharpen && result.converged) {
    Estimate sharp = search.evaluate_at(wide.pose, Covariance::sharp);
    result.sharpened =
        search.climb(sharp, Covariance::sharp) && is_trustworthy(wide, sharp, map.resolution_m());
    if (result.sharpened) final = sharp;
  }
  result.pose = final.pose;
  result.covariance = to_roll_pitch_yaw_covariance(laplace_covariance(final.objective), final.pose);
  result.iterations = search.iterations();
  result.score = wide.objective.score;
  result.points_matched = wide.objective.points_matched;
  if (!points_m.empty())
    result.transformation_probability = result.score / static_cast<double>(points_m.size());
  if (wide.objective.points_matched != 0) {
    result.nearest_voxel_likelihood =
        wide.objective.best_score_sum / static_cast<double>(wide.objective.points_matched);
  }
  return result;
}

}  // namespace landfix::ndt
