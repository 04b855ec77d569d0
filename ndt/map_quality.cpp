#include "ndt/map_quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <Eigen/Eigenvalues>
#include <nanoflann.hpp>

namespace landfix::ndt {
namespace {

/// The quantile between ranks, as most statistics programs have it. Orders `values`, of which there are some.
[[nodiscard]] double upper_quartile(std::vector<double>& values) {
  const double rank = 0.75 * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), at, values.end());
  if (below + 1 == values.size()) return *at;
  const double above = *std::min_element(at + 1, values.end());
  return *at + (rank - static_cast<double>(below)) * (above - *at);
}

[[nodiscard]] double mean_of(double sum, std::uint64_t count) noexcept {
  return count != 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void MapQuality::add(const std::optional<PointQuality>& point) noexcept {
  ++points;
  if (!point) {
    ++skipped;
    return;
  }
  entropy_sum += point->entropy;
  plane_variance_sum_m += point->plane_variance_m;
}

MapQuality& MapQuality::operator+=(const MapQuality& more) noexcept {
  points += more.points;
  skipped += more.skipped;
  entropy_sum += more.entropy_sum;
  plane_variance_sum_m += more.plane_variance_sum_m;
  return *this;
}

double MapQuality::mean_map_entropy() const noexcept { return mean_of(entropy_sum, points - skipped); }

double MapQuality::mean_plane_variance_m() const noexcept {
  return mean_of(plane_variance_sum_m, points - skipped);
}

struct NeighbourTree::Index {
  std::vector<Eigen::Vector3f> points_m;

  // What nanoflann asks of a set of points.
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points_m.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t point, std::size_t axis) const {
    return points_m[point][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }

  // Distances in double precision: which points are neighbours does not hang on rounding.
  using Metric = nanoflann::L2_Simple_Adaptor<float, Index, double, std::uint32_t>;
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, Index, 3, std::uint32_t>;
  std::unique_ptr<Tree> tree;
};

namespace {

/// What nanoflann asks of who collects what it finds.
// NOLINTBEGIN(readability-identifier-naming): the names are nanoflann's
struct Within {
  double radius_m2;
  std::vector<std::uint32_t>& indices;

  [[nodiscard]] std::size_t size() const { return indices.size(); }
  [[nodiscard]] static bool full() { return true; }
  bool addPoint(double distance_m2, std::uint32_t index) {
    if (distance_m2 <= radius_m2) indices.push_back(index);
    return true;
  }
  [[nodiscard]] double worstDist() const { return std::nextafter(radius_m2, 2.0 * radius_m2); }
};
// NOLINTEND(readability-identifier-naming)

}  // namespace

NeighbourTree::NeighbourTree(std::vector<Eigen::Vector3f> points_m) : index_(std::make_unique<Index>()) {
  constexpr std::size_t kLeaf = 24;  // points: fewer make the tree larger, more the search slower
  if (points_m.size() > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("more than 4,294,967,295 points: look at a part of them");
  index_->points_m = std::move(points_m);
  index_->tree = std::make_unique<Index::Tree>(3, *index_, nanoflann::KDTreeSingleIndexAdaptorParams(kLeaf));
}

NeighbourTree::~NeighbourTree() = default;

std::span<const Eigen::Vector3f> NeighbourTree::points_m() const noexcept { return index_->points_m; }

void NeighbourTree::find(std::size_t i, double radius_m, std::vector<std::uint32_t>& indices) const {
  indices.clear();
  Within within{.radius_m2 = radius_m * radius_m, .indices = indices};
  index_->tree->findNeighbors(within, index_->points_m[i].data(), nanoflann::SearchParams());
}

std::optional<PointQuality> QualityProbe::at(std::size_t i) {
  tree_.find(i, radius_m_, indices_);
  if (indices_.size() < kLeastNeighbours) return std::nullopt;
  // From the point itself: it is near, so the sums lose nothing.
  const std::span points_m = tree_.points_m();
  const Eigen::Vector3d here_m = points_m[i].cast<double>();
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products_m2 = Eigen::Matrix3d::Zero();
  for (const std::uint32_t index : indices_) {
    const Eigen::Vector3d from_here_m = points_m[index].cast<double>() - here_m;
    sum_m += from_here_m;
    products_m2 += from_here_m * from_here_m.transpose();
  }
  const auto count = static_cast<double>(indices_.size());
  const Eigen::Vector3d mean_m = sum_m / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(products_m2 / count -
                                                            mean_m * mean_m.transpose());
  constexpr double kTwoPiE = 2.0 * std::numbers::pi * std::numbers::e;
  constexpr double kFlat = 1e-14;  // of the largest: double precision knows no less
  const Eigen::Vector3d& variances_m2 = axes.eigenvalues();
  if (!(variances_m2[0] > kFlat * variances_m2[2])) return std::nullopt;

  const Eigen::Vector3d normal = axes.eigenvectors().col(0);
  distances_m_.clear();
  for (const std::uint32_t index : indices_) {
    const Eigen::Vector3d from_mean_m = points_m[index].cast<double>() - here_m - mean_m;
    distances_m_.push_back(std::abs(normal.dot(from_mean_m)));
  }
  return PointQuality{.neighbours = static_cast<std::uint32_t>(indices_.size()),
                      .entropy = 0.5 * (kTwoPiE * variances_m2).array().log().sum(),
                      .plane_variance_m = upper_quartile(distances_m_)};
}

}  // namespace landfix::ndt
