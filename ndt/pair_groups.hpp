// Which voxels each point of a scan is paired with, remembered from one step of the search to the next.
// Looking pairs up costs more than all that is computed from them, and a step moves points little: so voxels
// a margin beyond the reach of a pair are kept too, and a group of points is looked up again only when it has
// moved by more than the margin. What is a pair at a pose is then decided exactly, by distance
// (pair_kernel.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ndt/pose.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// Which covariance of the voxels counts.
enum class Covariance : std::uint8_t { wide, sharp };

/// Points that are neighbours in the scan, so that one local origin serves single precision for all.
inline constexpr std::size_t kGroupPoints = 64;
/// Room for the candidates of a group.
inline constexpr std::size_t kGroupPairs = 1024;

/// The candidates of one group, a column a field so that they are worked on several at a time. Positions are
/// relative: points to the group's centre (frame `vehicle`), means to its origin (frame `map`).
struct alignas(64) PairColumns {
  template <class T>
  using Column = std::array<T, kGroupPairs + 16>;  // a whole vector may be written behind the last pair

  std::array<Column<float>, 3> point_m;
  std::array<Column<float>, 3> mean_m;
  std::array<Column<float>, 6> inverse_covariance_1pm2;
  Column<std::uint32_t> voxel;
  Column<std::uint32_t> point;  ///< in the group
};

/// In resolutions. Both together are less than two.
struct Reach {
  double pair = 1.0;    ///< a point and a voxel's mean are a pair within it
  double margin = 0.1;  ///< beyond it, candidates
};

struct PairGroup {
  std::size_t first_point = 0;
  std::size_t point_count = 0;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< of its points, frame `vehicle`
  double radius_m = 0.0;                               ///< of its points around the centre
  Cell origin;                                         ///< of the means
  Pose looked_up_at = Pose::Identity();
  std::size_t pair_count = 0;
  bool is_looked_up = false;
  Covariance covariance = Covariance::wide;  ///< that its candidates have
};

/// Allocates in its constructor only.
class PairGroups {
 public:
  /// A group is of as many points as find room for their candidates where every cell of the map has a voxel.
  explicit PairGroups(std::size_t max_points, const Reach& reach = {});

  /// Takes the points (frame `vehicle`, neighbours near each other), or `most` of them, spread over all, as
  /// far as there is room; no pairs yet. Points that are not finite, or farther than any LiDAR sees, are left
  /// out.
  void assign(std::span<const Eigen::Vector3f> points_m, std::size_t most = SIZE_MAX) noexcept;

  /// Makes a group's candidates hold at the pose: looks them up if it has moved too far.
  void update(const VoxelMap& map, const Pose& pose, Covariance covariance, std::size_t group) noexcept;

  [[nodiscard]] std::span<const PairGroup> groups() const noexcept {
    return std::span<const PairGroup>(groups_).first(group_count_);
  }
  /// Of one group, relative to its centre.
  [[nodiscard]] std::span<const Eigen::Vector3f> points_m(std::size_t group) const noexcept {
    return std::span(points_m_).subspan(groups_[group].first_point, groups_[group].point_count);
  }
  [[nodiscard]] const PairColumns& columns(std::size_t group) const noexcept { return columns_[group]; }
  [[nodiscard]] const Reach& reach() const noexcept { return reach_; }
  /// Candidates that did not fit their group since the points were assigned.
  [[nodiscard]] std::size_t dropped_pairs() const noexcept { return dropped_pairs_; }

  [[nodiscard]] std::size_t memory_bytes() const noexcept {
    return points_m_.size() * sizeof(points_m_[0]) + groups_.size() * sizeof(PairGroup) +
           columns_.size() * sizeof(PairColumns);
  }

 private:
  void look_up(const VoxelMap& map, const Pose& pose, std::size_t index) noexcept;
  void fill_covariances(const VoxelMap& map, std::size_t index) noexcept;

  Reach reach_;
  std::size_t points_per_group_ = 0;
  std::size_t group_count_ = 0;
  std::size_t dropped_pairs_ = 0;
  std::vector<Eigen::Vector3f> points_m_;  ///< relative to their group's centre
  std::vector<PairGroup> groups_;
  std::vector<PairColumns> columns_;
};

}  // namespace landfix::ndt
