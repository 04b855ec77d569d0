// Directions that the scan and the map do not hold: along a tunnel, across an open field.
//
// A voxel map is never flat: even along a featureless wall each voxel pulls towards its mean, and over
// thousands of points that adds up to a confident, and false, answer. Two tests tell it from a real one:
//   1. Is the pull along a direction stronger than that of surfaces without features
//      (ScanInformation::lattice)? The ratio was 1.2 to 1.9 along simulated tunnels and fields, and 4 to 14
//      in the weakest direction of streets, with sensors of 16 to 64 lasers and filters of 1 to 5 m.
//   2. If not: does the score fall half a voxel to either side, so that points are out of step with the
//      voxels? By -3 to 4 % along tunnels and fields, by 13 to 60 % in streets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "ndt/scan_information.hpp"

namespace landfix::ndt {

/// Directions of the vehicle, in the order of a Twist.
enum class Axis : std::uint8_t { longitudinal, lateral, vertical, roll, pitch, yaw };
[[nodiscard]] std::string_view to_string(Axis axis) noexcept;

/// Six independent directions of motion, some of them weak.
struct Directions {
  /// Columns, ascending by how well they are held; of unit length in the metric, which measures how far a
  /// motion displaces the points.
  Matrix6 basis = Matrix6::Identity();
  Matrix6 metric = Matrix6::Identity();
  /// Of a motion that displaces the points by 1 m, root mean square.
  double length_per_m = 1.0;
  std::array<bool, 6> is_weak{};

  [[nodiscard]] bool any_weak() const noexcept;
  /// The part of a motion in the weak directions.
  [[nodiscard]] Twist weak_part(const Twist& motion) const noexcept;
};

/// At an optimum of the sharp covariances, or near it; `information` is of these. Probes the score around it
/// where the first test asks for it.
[[nodiscard]] Directions find_directions(const VoxelMap& map, PairGroups& groups, const Pose& pose,
                                         const ScanInformation& information,
                                         const ScoreConstants& constants) noexcept;

/// A weak direction as its user knows it.
struct WeakDirection {
  Axis axis{};                      ///< the nearest
  Twist direction = Twist::Zero();  ///< the axis as far as it is weak, frame `vehicle`, of length 1
  double sigma = 0.0;               ///< of the pose along or about the axis [m or rad]
};

struct WeakDirections {
  std::array<WeakDirection, 6> at{};
  std::size_t count = 0;

  [[nodiscard]] std::span<const WeakDirection> all() const noexcept { return std::span(at).first(count); }
};

/// Names as many axes of the vehicle as there are weak directions. `vehicle_covariance`: of the pose, as a
/// Twist in the vehicle's axes.
[[nodiscard]] WeakDirections name_weak(const Directions& directions, const Pose& pose,
                                       const Matrix6& vehicle_covariance) noexcept;

}  // namespace landfix::ndt
