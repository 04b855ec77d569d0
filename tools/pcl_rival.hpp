// PCL as what landfix is measured against: its NDT, its voxel filter, its map, set as a careful user would.
// Data is handed over before it is worked on, so that only the work is timed.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include <Eigen/Core>

#include "ndt/pose.hpp"

namespace landfix::tools {

/// What a search found.
struct Found {
  ndt::Pose pose = ndt::Pose::Identity();  ///< map <- vehicle
  int iterations = 0;
};

class PclRival {
 public:
  /// `resolution_m`: of the map. `leaf_m`: of the filter. Throws UsageError where landfix was built without
  /// PCL.
  PclRival(double resolution_m, double leaf_m);
  ~PclRival();
  PclRival(const PclRival&) = delete;
  PclRival& operator=(const PclRival&) = delete;

  /// Whether landfix was built with PCL.
  [[nodiscard]] static bool available() noexcept;
  [[nodiscard]] static std::string name();  ///< with the version

  void set_map(std::span<const Eigen::Vector3d> points_m);
  /// Of the points set.
  void build_map();
  /// Frame `vehicle`.
  void set_scan(std::span<const Eigen::Vector3f> points_m);
  /// Thins the scan set; how many points are left.
  std::size_t filter();
  /// Of the scan that was filtered last, with the map that was built last.
  [[nodiscard]] Found match(const ndt::Pose& guess);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace landfix::tools
