// Which points of a scan are matched: three ways to thin it, chosen by name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "ndt/voxel_grid.hpp"

namespace landfix::ndt {

enum class FilterKind : std::uint8_t {
  voxel,    ///< the centroid of each cell
  ring,     ///< the centroid of each ring in each cell: every ring survives
  entropy,  ///< of the cells' centroids, those whose points scatter least
};
inline constexpr std::array<std::string_view, 3> kFilterNames{"voxel", "ring", "entropy"};
[[nodiscard]] std::optional<FilterKind> find_filter(std::string_view name) noexcept;

struct FilterSettings {
  FilterKind kind = FilterKind::voxel;
  double leaf_m = 2.0;         ///< edge of a cell, > 0
  double entropy_share = 0.5;  ///< of the cells with points, those that `entropy` keeps, (0, 1]
};

/// Takes points as they are decoded, as VoxelGrid does. Allocates in its constructor only.
class ScanFilter {
 public:
  /// `capacity`: points that it can give.
  ScanFilter(const FilterSettings& settings, std::size_t capacity);

  void clear() noexcept { grid_.clear(); }
  /// `ring`: 0 where it is not known.
  void add(const Eigen::Vector3f& point_m, std::uint16_t ring) noexcept { grid_.add(point_m, ring); }
  /// The same for many at once. `rings`: one for each point, or none.
  void add(std::span<const Eigen::Vector3f> points_m, std::span<const std::uint16_t> rings) noexcept;
  /// Neighbours in space near each other in memory. The caller may move the points; they are valid until the
  /// next `finish`.
  [[nodiscard]] std::span<Eigen::Vector3f> finish() noexcept;

  /// Points since `clear` for which there was no room, or that were not finite; known once `finish` has run.
  [[nodiscard]] std::size_t dropped_points() const noexcept { return grid_.dropped_points(); }

 private:
  [[nodiscard]] std::span<Eigen::Vector3f> keep_lowest_entropy(std::span<Eigen::Vector3f> points_m) noexcept;

  FilterSettings settings_;
  VoxelGrid grid_;
  std::vector<float> known_;
};

}  // namespace landfix::ndt
