// Newton's method on the objective: climbs from a pose to the nearest maximum.
#pragma once

#include "ndt/deadline.hpp"
#include "ndt/objective.hpp"
#include "ndt/pair_groups.hpp"
#include "ndt/pose.hpp"
#include "ndt/score.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// How a climb looks at the map, and when it ends.
struct Phase {
  Covariance covariance{};
  double narrowness = 1.0;  ///< factor of d2: below 1, voxels pull from farther away
  double tolerance_m = 0.0;
  double tolerance_rad = 0.0;  ///< a step shorter than both is the last, and taken untried
  int max_iterations = 1000;   ///< of this climb; the search has a limit of its own
};

struct StepLimits {
  double length_m = 0.0;
  double angle_rad = 0.0;
};

/// Where a climb ended.
struct Estimate {
  Pose pose = Pose::Identity();
  Objective objective;     ///< at the pose, or a last step before it
  bool converged = false;  ///< not for want of iterations, nor for want of pairs
};

/// Several climbs share one allowance of iterations, which are evaluations of the objective, and one
/// deadline: a climb that it cuts short has not converged.
class NewtonSearch {
 public:
  /// `map` must outlive the search.
  NewtonSearch(const VoxelMap& map, const ScoreConstants& constants, const StepLimits& limits,
               int max_iterations, const Deadline& deadline = {}) noexcept
      : map_(map),
        constants_(constants),
        limits_(limits),
        max_iterations_(max_iterations),
        deadline_(deadline) {}

  /// Climbs until a step is negligible. Each step but such a one is tried before it is taken and must not
  /// lower the score.
  [[nodiscard]] Estimate climb(const Pose& start, PairGroups& groups, const Phase& phase) noexcept;

  [[nodiscard]] int iterations() const noexcept { return iterations_; }
  /// The deadline has cut a climb short.
  [[nodiscard]] bool was_cut_short() const noexcept { return was_cut_short_; }

 private:
  [[nodiscard]] bool may_go_on(int last_iteration) noexcept;
  [[nodiscard]] Estimate evaluate_at(const Pose& pose, PairGroups& groups, const Phase& phase) noexcept;

  const VoxelMap& map_;
  ScoreConstants constants_;
  StepLimits limits_;
  int max_iterations_;
  int iterations_ = 0;
  Deadline deadline_;
  bool was_cut_short_ = false;
};

}  // namespace landfix::ndt
