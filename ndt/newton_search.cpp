#include "ndt/newton_search.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace landfix::ndt {
namespace {

/// How bold a step is: how much of the curvature it trusts, and its damping after Levenberg and Marquardt.
struct Boldness {
  static constexpr double kMinDamping = 1e-5;
  static constexpr double kMaxDamping = 1e4;

  double curvature = 1.0;
  double damping = kMinDamping;

  void grow() noexcept {
    curvature = 1.0;
    damping = std::max(0.1 * damping, kMinDamping);
  }
  /// Without the curvature a step is one of iteratively reweighted least squares, which hardly ever lowers
  /// the score; where it does, the pairs have changed on its way.
  void shrink() noexcept {
    if (curvature > 0.0) {
      curvature = 0.0;
    } else {
      damping = std::max(10.0 * damping, 0.1);
    }
  }
};

/// Newton's step with as much of the curvature as leaves the Hessian positive definite.
[[nodiscard]] Twist newton_step(const Objective& objective, const Boldness& boldness) noexcept {
  constexpr double kDefinite = 1e-3;  // of the definite part's diagonal
  const Twist scale = objective.definite.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  const Matrix6 definite = scale.asDiagonal() * objective.definite * scale.asDiagonal();
  const Matrix6 curvature = scale.asDiagonal() * objective.curvature * scale.asDiagonal();
  const Twist gradient = scale.cwiseProduct(objective.gradient);
  Eigen::LDLT<Matrix6> ldlt;
  for (const double share : {1.0, 0.75, 0.5, 0.25, 0.0}) {
    if (share > boldness.curvature) continue;
    ldlt.compute(definite - share * curvature + boldness.damping * Matrix6::Identity());
    if (ldlt.info() == Eigen::Success && ldlt.vectorD().minCoeff() > kDefinite) break;
  }
  // Directions that nothing constrains have a pivot near 0: LDLT's solve leaves them where they are.
  return scale.cwiseProduct(ldlt.solve(gradient).eval());
}

[[nodiscard]] Twist limited(const Twist& step, const StepLimits& limits) noexcept {
  const double factor = std::min({1.0, limits.length_m / std::max(step.head<3>().norm(), 1e-12),
                                  limits.angle_rad / std::max(step.tail<3>().norm(), 1e-12)});
  return factor * step;
}

}  // namespace

bool NewtonSearch::may_go_on(int last_iteration) noexcept {
  if (iterations_ >= last_iteration) return false;
  was_cut_short_ = was_cut_short_ || deadline_.has_passed();
  return !was_cut_short_;
}

Estimate NewtonSearch::evaluate_at(const Pose& pose, PairGroups& groups, const Phase& phase) noexcept {
  ++iterations_;
  const ScoreConstants constants{.d1 = constants_.d1, .d2 = phase.narrowness * constants_.d2};
  return {.pose = pose, .objective = evaluate(map_, groups, pose, phase.covariance, constants)};
}

Estimate NewtonSearch::climb(const Pose& start, PairGroups& groups, const Phase& phase) noexcept {
  const int last_iteration = std::min(max_iterations_, iterations_ + phase.max_iterations);
  if (!may_go_on(last_iteration)) return {.pose = start, .objective = {}};
  Estimate best = evaluate_at(start, groups, phase);
  if (best.objective.pairs == 0) return best;
  Boldness boldness;
  while (may_go_on(last_iteration)) {
    const Twist step = limited(newton_step(best.objective, boldness), limits_);
    const Pose after = moved(best.pose, step);
    const bool is_negligible =
        step.head<3>().norm() < phase.tolerance_m && step.tail<3>().norm() < phase.tolerance_rad;
    best.converged = is_negligible || boldness.damping > Boldness::kMaxDamping;
    if (is_negligible) best.pose = after;
    if (best.converged) break;
    const Estimate next = evaluate_at(after, groups, phase);
    if (next.objective.score >= best.objective.score) {
      best = next;
      boldness.grow();
    } else {
      boldness.shrink();
    }
  }
  return best;
}

}  // namespace landfix::ndt
