// What is said of an optimum that was found: which directions nothing holds, that these follow the guess
// ("solution remapping": Zhang, Kaess and Singh, "On Degeneracy of Optimization-based State Estimation
// Problems", ICRA 2016), and how uncertain it all is.
#pragma once

#include "ndt/degeneracy.hpp"
#include "ndt/pair_groups.hpp"
#include "ndt/pose.hpp"
#include "ndt/score.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

struct Guess {
  Pose pose = Pose::Identity();  ///< map <- vehicle
  double sigma_m = 1.0;          ///< how far it may be off, as the displacement of points
};

struct Assessment {
  Pose pose = Pose::Identity();          ///< the optimum, with the guess's part in the weak directions
  Matrix6 covariance = Matrix6::Zero();  ///< x y z roll pitch yaw [m, rad], frame `map`
  WeakDirections weak{};
};

/// `optimum`: of the score with `covariance`, where at least one pair is. `sharp`: of the sharp covariances
/// there, since wide ones hide what holds a direction and what does not.
[[nodiscard]] Assessment assess(const VoxelMap& map, PairGroups& groups, const Pose& optimum,
                                Covariance covariance, const ScanInformation& sharp,
                                const ScoreConstants& constants, const Guess& guess) noexcept;

}  // namespace landfix::ndt
