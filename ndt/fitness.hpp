// The fitness score of the reference study: how far the scan's points are from the map's voxels.
#pragma once

#include <memory>
#include <span>

#include <Eigen/Core>

#include "ndt/pose.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// A search tree over the means of a map's voxels.
class FitnessScore {
 public:
  explicit FitnessScore(const VoxelMap& map);
  ~FitnessScore();
  FitnessScore(const FitnessScore&) = delete;
  FitnessScore& operator=(const FitnessScore&) = delete;

  /// Mean over the points of the squared distance [m^2] from the point, placed by `pose` (map <- vehicle), to
  /// the nearest mean of a voxel, however far; lower is better. NaN without points.
  [[nodiscard]] double operator()(std::span<const Eigen::Vector3f> points_m, const Pose& pose) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace landfix::ndt
