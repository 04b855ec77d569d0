// Where a vehicle may have got to since it was last seen, on the ground that the map shows: a sequence of
// guesses that fills it evenly, and what the map says of each at first sight.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "ndt/pose.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// A pose, and how many of some points fall into voxels there.
struct RankedGuess {
  Pose pose = Pose::Identity();
  std::size_t hits = 0;
};

/// Relative to some pose, in the plane: x, y, heading. Without end, and always the same.
class GuessSequence {
 public:
  /// Where a vehicle may have got to, by a way of at most `reach_m`: every other guess is on a path of
  /// straight, curve, straight; the rest is anywhere within reach, with any heading.
  [[nodiscard]] Eigen::Vector3d next_on_way(double reach_m) noexcept;
  /// Within a circle, with a heading within `heading_rad` of 0.
  [[nodiscard]] Eigen::Vector3d next_around(double within_m, double heading_rad) noexcept;

 private:
  [[nodiscard]] std::array<double, 3> next_fractions() noexcept;
  // The additive recurrence of lowest discrepancy in three dimensions (Roberts, 2018), in units of 2^-64.
  std::array<std::uint64_t, 3> state_{};
  bool is_path_ = false;
};

/// The way that a vehicle can have made in that time, from that speed on.
[[nodiscard]] double reach_m(double speed_mps, double duration_s) noexcept;

/// The height of the voxel above or below a place that is nearest to it, within `within_m`.
[[nodiscard]] std::optional<double> ground_m(const VoxelMap& map, const Eigen::Vector3d& place_m,
                                             double within_m) noexcept;
/// Heights on which a vehicle may stand at a place, lowest first, at most as many as there is room for: of
/// voxels between `lowest_m` and 30 m above that have 2 m of room over them. How many there are.
[[nodiscard]] std::size_t find_floors(const VoxelMap& map, const Eigen::Vector2d& place_m, double lowest_m,
                                      std::span<double> heights_m) noexcept;
/// The height of the lowest voxel of the blocks within `within_m` of a place, horizontally. Looks at all of
/// them.
[[nodiscard]] std::optional<double> lowest_m(const VoxelMap& map, const Eigen::Vector2d& place_m,
                                             double within_m) noexcept;
/// The pose with the roll and pitch that the ground around it has; as it is where there is none.
[[nodiscard]] Pose on_slope(const VoxelMap& map, const Pose& pose) noexcept;

/// Of the points that tell one place from another, those above the ground, a few.
class Landmarks {
 public:
  explicit Landmarks(std::span<const Eigen::Vector3f> points_m) noexcept;
  /// Those that fall into a voxel.
  [[nodiscard]] std::size_t hits(const VoxelMap& map, const Pose& pose) const noexcept;

 private:
  static constexpr std::size_t kMost = 160;
  std::array<Eigen::Vector3f, kMost> points_m_;
  std::size_t count_ = 0;
};

}  // namespace landfix::ndt
