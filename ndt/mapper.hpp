// NDT mapping: each sweep is matched to the map that those before it have made, and is added to it once the
// vehicle has moved on. Not for the hot path: it allocates.
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "ndt/map_image.hpp"
#include "ndt/matcher.hpp"
#include "ndt/motion.hpp"
#include "ndt/pose.hpp"
#include "ndt/voxel_map.hpp"
#include "ndt/voxel_map_builder.hpp"
#include "ndt/voxel_moments.hpp"

namespace landfix::ndt {

/// Tuned on routes A, B and C with a VLP-16: coarser voxels have more rings in them and reach farther, and
/// the oftener a sweep is added, the less is it matched to what only few have seen from farther away.
struct MapperSettings {
  double resolution_m = 2.0;
  MatcherSettings matcher;
  PointSource source = PointSource::sweeps;  ///< survey: every cell is as its points lie, as in plain NDT
  double add_after_m = 0.5;                  ///< of travel since the last sweep that was added
  double forget_beyond_m = 250;  ///< of the vehicle, horizontally: what is matched to; the memory follows it
};

/// Remembers what lies near the vehicle; who wants all of the map collects the points that it takes.
class Mapper {
 public:
  /// `first_pose`: map <- vehicle at the first sweep.
  Mapper(const MapperSettings& settings, const Pose& first_pose);

  /// The constant velocity from the sweep before the last to the last; zero before there are two.
  [[nodiscard]] const Velocity& velocity() const noexcept { return velocity_; }
  /// Where the vehicle is expected.
  [[nodiscard]] Pose predicted_pose(std::int64_t stamp_utc_ns) const noexcept;
  /// The velocity if the vehicle is there then.
  [[nodiscard]] Velocity velocity_to(const StampedPose& at) const noexcept;

  /// Where the sweep fits. `points_m`: deskewed and filtered, frame `vehicle` at `stamp_utc_ns`. Changes
  /// nothing that the next match sees. The first sweep is where the first pose says.
  [[nodiscard]] MatchResult match(std::span<const Eigen::Vector3f> points_m, std::int64_t stamp_utc_ns);
  /// The sweep is there. Whether its points are to be added: the first, and each after `add_after_m`.
  [[nodiscard]] bool settle(const StampedPose& at) noexcept;
  /// Adds the points of a sweep, not thinned, frame `vehicle` at `pose`.
  void add(std::span<const Eigen::Vector3f> points_m, const Pose& pose);

  [[nodiscard]] const VoxelMap& map() const noexcept { return map_; }
  [[nodiscard]] double travelled_m() const noexcept { return travelled_m_; }

 private:
  MapperSettings settings_;
  Matcher matcher_;
  VoxelMapBuilder builder_;
  MapImage image_;
  VoxelMap map_;
  StampedPose last_;
  Velocity velocity_ = Velocity::Zero();
  bool is_first_ = true;
  double travelled_m_ = 0.0;
  double last_added_m_ = 0.0;      ///< of the way travelled
  Eigen::Vector3d last_forgot_m_;  ///< where the vehicle was
};

}  // namespace landfix::ndt
