#include "ndt/fitness.hpp"

#include <cstddef>
#include <limits>
#include <vector>

#include <nanoflann.hpp>

namespace landfix::ndt {

struct FitnessScore::Tree {
  std::vector<Eigen::Vector3d> means_m;

  // What nanoflann asks of a set of points.
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return means_m.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t point, std::size_t axis) const {
    return means_m[point][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }

  using Index =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Tree>, Tree, 3, std::size_t>;
  std::unique_ptr<Index> index;
};

FitnessScore::FitnessScore(const VoxelMap& map) : tree_(std::make_unique<Tree>()) {
  tree_->means_m.reserve(map.voxels().size());
  visit_voxels(map, [this](const Voxel& /*voxel*/, const Eigen::Vector3d& mean_m) {
    tree_->means_m.push_back(mean_m);
  });
  tree_->index = std::make_unique<Tree::Index>(3, *tree_);
}

FitnessScore::~FitnessScore() = default;

double FitnessScore::operator()(std::span<const Eigen::Vector3f> points_m, const Pose& pose) const {
  if (points_m.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum_m2 = 0.0;
  for (const Eigen::Vector3f& point_m : points_m) {
    const Eigen::Vector3d place_m = pose * point_m.cast<double>();
    std::size_t nearest = 0;
    double distance_m2 = 0.0;
    tree_->index->knnSearch(place_m.data(), 1, &nearest, &distance_m2);
    sum_m2 += distance_m2;
  }
  return sum_m2 / static_cast<double>(points_m.size());
}

}  // namespace landfix::ndt
