// The function that matching maximises: how well the map explains a scan at a pose, with its derivatives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "ndt/pose.hpp"
#include "ndt/score.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// Which covariance of the voxels counts.
enum class Covariance : std::uint8_t { wide, sharp };

/// A point p of the scan (frame `vehicle`) and a voxel with mean m and inverse covariance C, paired where m
/// lies within one resolution of p in the map, contribute s = d1 exp(-d2/2 (p - m)' C (p - m)).
///
/// Derivatives are by a left perturbation about the vehicle, R <- exp(w) R and t <- t + v: `Twist` is (v, w).
struct Objective {
  double score = 0.0;              ///< sum over the pairs
  Twist gradient = Twist::Zero();  ///< d score / d twist
  /// The Hessian of -score is `definite - curvature` plus terms of second order in the rotation, which vanish
  /// with the residuals; both are positive semidefinite.
  Matrix6 definite = Matrix6::Zero();
  Matrix6 curvature = Matrix6::Zero();
  double best_score_sum = 0.0;     ///< over the points, each with its best voxel
  std::size_t points_matched = 0;  ///< points with at least one voxel
  std::size_t pairs = 0;
};

[[nodiscard]] Objective evaluate(const VoxelMap& map, std::span<const Eigen::Vector3f> points_m,
                                 const Pose& pose, Covariance covariance,
                                 const ScoreConstants& constants) noexcept;

}  // namespace landfix::ndt
