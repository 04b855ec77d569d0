// A drive made into a map: sweeps go in, points of the map, poses and metrics come out as files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "drivers/sweep.hpp"
#include "ndt/fitness.hpp"
#include "ndt/mapper.hpp"
#include "ndt/motion.hpp"
#include "ndt/pose.hpp"
#include "ndt/scan_filter.hpp"
#include "platform/pcd_writer.hpp"
#include "tools/input_files.hpp"

namespace landfix::tools {

struct MappingSettings {
  ndt::MapperSettings mapper;
  ndt::FilterSettings filter{.leaf_m = 0.7};
  RangeLimits limits;
  bool deskew = true;
  ndt::Pose sensor_pose = ndt::Pose::Identity();  ///< vehicle <- sensor
  ndt::Pose first_pose = ndt::Pose::Identity();   ///< map <- vehicle
};

/// The reference study's, which undid no distortion and made voxels of whatever points lay in them.
[[nodiscard]] MappingSettings study_mapping();

/// What was found of one sweep.
struct MappedSweep {
  ndt::StampedPose at;
  ndt::MatchResult match{};
  double fitness_score_m2 = 0.0;
  double travelled_m = 0.0;
  double match_ms = 0.0;
  bool added = false;
};

class MappingRun {
 public:
  /// Writes map.pcd in the folder, which there is. Throws std::runtime_error where it cannot.
  MappingRun(const MappingSettings& settings, const std::filesystem::path& folder);

  /// Decoded between the limits of range.
  void add(const drivers::Sweep& sweep);
  /// A scan that is free of distortion, frame `vehicle`, between the limits of range.
  void add(std::span<const Eigen::Vector3f> points_m, std::int64_t stamp_utc_ns);

  /// Gives map.pcd its name and writes trajectory.tum and metrics.csv.
  void finish();

  [[nodiscard]] std::span<const MappedSweep> sweeps() const noexcept { return sweeps_; }
  [[nodiscard]] std::uint64_t map_points() const noexcept { return map_points_; }

 private:
  [[nodiscard]] ndt::MatchResult match(std::span<const Eigen::Vector3f> points_m, std::int64_t stamp_utc_ns);
  void undistort(const drivers::Sweep& sweep, const ndt::Velocity& velocity);
  void settle(MappedSweep sweep, std::span<const Eigen::Vector3f> points_m);

  MappingSettings settings_;
  std::filesystem::path folder_;
  ndt::Mapper mapper_;
  ndt::ScanFilter filter_;
  ndt::Deskew deskew_;
  std::vector<Eigen::Vector3f> points_m_;        ///< of a sweep, frame `vehicle` at its end
  std::span<const Eigen::Vector3f> filtered_m_;  ///< the filter's, of the last match
  std::optional<ndt::FitnessScore> fitness_;     ///< of the mapper's map
  platform::PcdStream cloud_;
  std::uint64_t map_points_ = 0;
  std::vector<MappedSweep> sweeps_;
};

}  // namespace landfix::tools
