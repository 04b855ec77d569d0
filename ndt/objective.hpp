// The function that matching maximises: how well the map explains a scan at a pose, with its derivatives.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "ndt/pair_groups.hpp"
#include "ndt/pose.hpp"
#include "ndt/score.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// A point p of the scan (frame `vehicle`) and a voxel with mean m and inverse covariance C, paired where m
/// lies within reach of p in the map (PairGroups), contribute s = d1 exp(-d2/2 (p - m)' C (p - m)).
///
/// Derivatives are by a left perturbation about the vehicle, R <- exp(w) R and t <- t + v: `Twist` is (v, w).
struct Objective {
  double score = 0.0;              ///< sum over the pairs
  Twist gradient = Twist::Zero();  ///< d score / d twist
  /// The Hessian of -score is `definite - curvature` plus terms of second order in the rotation, which vanish
  /// with the residuals; both are positive semidefinite.
  Matrix6 definite = Matrix6::Zero();
  Matrix6 curvature = Matrix6::Zero();
  std::size_t pairs = 0;
};

/// Of the points in `groups`, whose pairs it brings up to date, as the functions below do.
[[nodiscard]] Objective evaluate(const VoxelMap& map, PairGroups& groups, const Pose& pose,
                                 Covariance covariance, const ScoreConstants& constants) noexcept;

/// Of one of the groups.
[[nodiscard]] Objective evaluate_group(const VoxelMap& map, PairGroups& groups, std::size_t group,
                                       const Pose& pose, Covariance covariance,
                                       const ScoreConstants& constants) noexcept;

/// What single points score, each with its best voxel; of those that have one within reach.
struct BestScores {
  double sum = 0.0;
  std::size_t points = 0;

  void add(double score) noexcept {
    sum += score;
    ++points;
  }
  [[nodiscard]] double mean() const noexcept { return points != 0 ? sum / static_cast<double>(points) : 0.0; }
};

struct PointScores {
  double sum = 0.0;  ///< over all pairs
  BestScores all;
  BestScores no_ground;  ///< of points more than kAboveGround_m above the vehicle's origin
};

[[nodiscard]] PointScores score_points(const VoxelMap& map, PairGroups& groups, const Pose& pose,
                                       Covariance covariance, const ScoreConstants& constants) noexcept;

}  // namespace landfix::ndt
