// The matcher: Newton's method that moves a scan until the map explains it best.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "ndt/deadline.hpp"
#include "ndt/degeneracy.hpp"
#include "ndt/pair_groups.hpp"
#include "ndt/pose.hpp"
#include "ndt/score.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

struct MatcherSettings {
  int max_iterations = 50;      ///< evaluations of the objective, all phases together
  double outlier_ratio = 0.55;  ///< 0: the plain exponential
  double step_limit_m = 0.3;
  double step_limit_rad = 0.03;
  double converged_m = 5e-4;  ///< a step shorter than both is the last: the next would be a tenth of it
  double converged_rad = 5e-5;
  bool sharpen = true;           ///< finish on the sharp covariances where that can be trusted
  std::size_t few_points = 200;  ///< that lead the search, about; 0: none do
};

struct MatchResult {
  Pose pose = Pose::Identity();  ///< map <- vehicle
  /// x y z roll pitch yaw [m, rad], frame `map`; a variance of 1e6 where nothing overlaps.
  Matrix6 covariance = 1e6 * Matrix6::Identity();
  WeakDirections weak{};                    ///< that the scan does not hold: the pose follows the guess there
  double score = 0.0;                       ///< of the wide covariances, over all points
  double transformation_probability = 0.0;  ///< score a point
  double nearest_voxel_likelihood = 0.0;    ///< best voxel's score, mean over the points that have one
  double no_ground_nearest_voxel_likelihood = 0.0;  ///< of the points above the ground (kAboveGround_m)
  double best_likelihood = 1.0;                     ///< the best score that a point can have with one voxel
  std::size_t points = 0;
  std::size_t points_matched = 0;            ///< with a voxel near
  std::size_t no_ground_points = 0;          ///< above the ground
  std::size_t no_ground_points_matched = 0;  ///< of these, with a voxel near
  std::size_t pairs_dropped = 0;  ///< candidates that found no room in their group, over the whole search
  int iterations = 0;             ///< evaluations of the objective
  bool converged = false;
  bool sharpened = false;
  bool out_of_time = false;  ///< the deadline came first: not converged

  /// Of the points that have a voxel, how well they fit, in [0, 1].
  [[nodiscard]] double likelihood() const noexcept { return nearest_voxel_likelihood / best_likelihood; }
  [[nodiscard]] double matched_share() const noexcept {
    return points == 0 ? 0.0 : static_cast<double>(points_matched) / static_cast<double>(points);
  }
  /// How much of the scan the map explains, and how well: at a wrong place it is both less.
  [[nodiscard]] double explained() const noexcept { return likelihood() * matched_share(); }
  /// The same of what stands in the scan: the ground explains itself anywhere.
  [[nodiscard]] double standing_explained() const noexcept {
    if (no_ground_points == 0) return 0.0;
    return no_ground_nearest_voxel_likelihood / best_likelihood *
           static_cast<double>(no_ground_points_matched) / static_cast<double>(no_ground_points);
  }
};

/// Each step that is not negligible is tried before it is taken and must not lower the score: the search
/// cannot diverge. No guess, scan or map makes it fail; what it found says `converged` or not. Where nothing
/// overlaps, the pose is the guess. Allocates in its constructor only.
class Matcher {
 public:
  /// `max_points`: of a scan; what is beyond is left out.
  explicit Matcher(const MatcherSettings& settings, std::size_t max_points = kMaxPoints);

  /// `points_m`: the filtered scan, frame `vehicle`, neighbours near each other (VoxelGrid). `guess`: map <-
  /// vehicle. `guess_sigma_m`: how far it may be off, as the displacement of points; nothing: a voxel's
  /// length. `deadline`: the search ends there, with what it has.
  [[nodiscard]] MatchResult match(const VoxelMap& map, std::span<const Eigen::Vector3f> points_m,
                                  const Pose& guess, std::optional<double> guess_sigma_m = std::nullopt,
                                  const Deadline& deadline = {}) noexcept;

  /// Allocated, and all of it used in the worst case.
  [[nodiscard]] std::size_t memory_bytes() const noexcept {
    return coarse_groups_.memory_bytes() + leading_groups_.memory_bytes() + groups_.memory_bytes();
  }

  static constexpr std::size_t kMaxPoints = 1 << 15;

 private:
  /// Of few points, from afar: a step moves them far, and voxels far away pull.
  static constexpr Reach kCoarseReach{.pair = 1.85, .margin = 0.1};

  MatcherSettings settings_;
  PairGroups coarse_groups_;
  PairGroups leading_groups_;
  PairGroups groups_;
};

}  // namespace landfix::ndt
