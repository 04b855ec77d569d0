// NDT as the formulas say it, in double precision and without a thought for speed: every voxel is tried for
// every point, and the Hessian is exact. What faster matchers are held against.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ndt/objective.hpp"
#include "ndt/pose.hpp"
#include "ndt/score.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt::test {

struct ReferenceVoxel {
  Eigen::Vector3d mean_m;  ///< frame `map`
  Eigen::Matrix3d inverse_covariance_1pm2;
};

/// The voxels of a map, places and shapes in double precision.
[[nodiscard]] std::vector<ReferenceVoxel> reference_voxels(const VoxelMap& map, Covariance covariance);

struct Pair {
  std::size_t point;
  std::size_t voxel;
};

/// All pairs whose mean lies within one resolution of the point.
[[nodiscard]] std::vector<Pair> find_pairs(std::span<const ReferenceVoxel> voxels,
                                           std::span<const Eigen::Vector3f> points_m, const Pose& pose,
                                           double resolution_m);

/// The objective and its exact derivatives by a left perturbation (see ndt/objective.hpp). Each
/// `absolute_...` is the sum of the absolute values of the contributions: the scale of rounding errors.
struct ReferenceObjective {
  double score = 0.0;
  Twist gradient = Twist::Zero();
  Matrix6 hessian = Matrix6::Zero();
  /// The terms of the Hessian that come from the second derivative of the rotation.
  Matrix6 second_order_rotation = Matrix6::Zero();
  double absolute_score = 0.0;
  Twist absolute_gradient = Twist::Zero();
  Matrix6 absolute_hessian = Matrix6::Zero();
};

[[nodiscard]] ReferenceObjective evaluate_pairs(std::span<const ReferenceVoxel> voxels,
                                                std::span<const Eigen::Vector3f> points_m,
                                                std::span<const Pair> pairs, const Pose& pose,
                                                const ScoreConstants& constants);

/// The pose of the maximum that the guess leads to, by damped Newton with the exact Hessian.
[[nodiscard]] Pose match(std::span<const ReferenceVoxel> voxels, std::span<const Eigen::Vector3f> points_m,
                         const Pose& guess, double resolution_m, const ScoreConstants& constants);

/// R <- exp(w) R, t <- t + v.
[[nodiscard]] Pose perturbed(const Pose& pose, const Twist& step);

}  // namespace landfix::ndt::test
