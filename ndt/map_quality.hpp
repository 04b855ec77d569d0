// How crisp a point map is: mean map entropy and mean plane variance (J. Razlaw et al., "Evaluation of
// Registration Methods for Sparse 3D Laser Scans", ECMR 2015), as the reference study has them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace landfix::ndt {

/// Of the points around one point, itself among them.
struct PointQuality {
  std::uint32_t neighbours = 0;
  double entropy = 0.0;           ///< of their normal distribution: 1/2 ln det(2 pi e S), S over their number
  double plane_variance_m = 0.0;  ///< upper quartile of their distances to their plane, which S gives
};

/// Sums over points, in whatever portions they come.
struct MapQuality {
  std::uint64_t points = 0;
  std::uint64_t skipped = 0;  ///< see QualityProbe::at
  double entropy_sum = 0.0;
  double plane_variance_sum_m = 0.0;

  void add(const std::optional<PointQuality>& point) noexcept;
  MapQuality& operator+=(const MapQuality& more) noexcept;
  /// NaN where every point was skipped.
  [[nodiscard]] double mean_map_entropy() const noexcept;
  [[nodiscard]] double mean_plane_variance_m() const noexcept;
};

/// A search tree over a point map.
class NeighbourTree {
 public:
  /// Throws std::length_error where there are 2^32 points or more. Takes 20 bytes a point with its own 12.
  explicit NeighbourTree(std::vector<Eigen::Vector3f> points_m);
  ~NeighbourTree();
  NeighbourTree(const NeighbourTree&) = delete;
  NeighbourTree& operator=(const NeighbourTree&) = delete;

  [[nodiscard]] std::span<const Eigen::Vector3f> points_m() const noexcept;
  /// The indices of all points within `radius_m` of point `i`. Any number of threads may ask at once.
  void find(std::size_t i, double radius_m, std::vector<std::uint32_t>& indices) const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
};

/// Looks at one point after the other; each thread has its own.
class QualityProbe {
 public:
  QualityProbe(const NeighbourTree& tree, double radius_m) noexcept : tree_(tree), radius_m_(radius_m) {}

  static constexpr std::size_t kLeastNeighbours = 5;
  /// Nothing where fewer points than those are within the radius, or where they lie in a plane, a line or a
  /// point to the precision of their coordinates and so have no entropy.
  [[nodiscard]] std::optional<PointQuality> at(std::size_t i);

 private:
  const NeighbourTree& tree_;
  double radius_m_;
  std::vector<std::uint32_t> indices_;
  std::vector<double> distances_m_;
};

}  // namespace landfix::ndt
