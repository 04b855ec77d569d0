// What a scan tells of its pose, and how much its parts differ about it: the raw material of the covariance
// and of the search for directions that nothing holds.
#pragma once

#include <cstddef>

#include "ndt/objective.hpp"
#include "ndt/pair_groups.hpp"
#include "ndt/pose.hpp"
#include "ndt/score.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// Sums over the groups of points, in the coordinates of Objective.
struct ScanInformation {
  Objective objective;
  std::size_t groups = 0;             ///< with a pair
  Matrix6 scatter = Matrix6::Zero();  ///< of g g', the gradients
  /// Of T T', where T is how a group's gradient changes as its points are displaced: its Hessian's columns of
  /// the translation.
  Matrix6 displacement = Matrix6::Zero();
  /// The definite part of the Hessian that surfaces without any features would have: a voxel cuts a piece out
  /// of a plane, whose points have a variance of resolution^2 / 12 along it, and that pulls.
  Matrix6 lattice = Matrix6::Zero();
};

/// Of the points in `groups`, whose pairs it brings up to date.
[[nodiscard]] ScanInformation gather_information(const VoxelMap& map, PairGroups& groups, const Pose& pose,
                                                 Covariance covariance,
                                                 const ScoreConstants& constants) noexcept;

}  // namespace landfix::ndt
