// What `landfix locate --scans` measures: how often the pose of a scan is found without a guess, and how long
// that takes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "ndt/plan_view.hpp"
#include "ndt/pose.hpp"
#include "ndt/scan_filter.hpp"
#include "ndt/voxel_map.hpp"
#include "tools/input_files.hpp"

namespace landfix::tools {

struct LocateSettings {
  ndt::FilterSettings filter;
  RangeLimits limits;
  std::size_t every = 1;           ///< of the scans, the first and then each so many
  std::optional<double> within_m;  ///< of the truth is looked; nothing: anywhere on the map
};

/// How one scan was located.
struct LocatedScan {
  std::string name;
  bool found = false;  ///< there was a candidate; else all that follows but the time is 0
  bool right = false;  ///< the first is within 10 cm and 0.5 deg of the truth
  bool sure = false;
  double confidence = 0.0;
  double error_m = 0.0;
  double error_rad = 0.0;
  double explained = 0.0;
  double rival_explained = 0.0;  ///< by the best of the others
  int plan_score = 0;            ///< see ndt::PlanPlace
  double seconds = 0.0;          ///< of CPU time
};

/// `truth`: map <- vehicle, one for each of `scans`.
[[nodiscard]] std::vector<LocatedScan> locate_all(const ndt::VoxelMap& map, const ndt::PlanView& plan,
                                                  std::span<const std::filesystem::path> scans,
                                                  std::span<const ndt::StampedPose> truth,
                                                  const LocateSettings& settings);

/// One line a scan, in the order of LocatedScan.
void write_table(const std::filesystem::path& path, std::span<const LocatedScan> scans);

[[nodiscard]] nlohmann::json to_json(std::span<const LocatedScan> scans, const ndt::PlanView& plan);
[[nodiscard]] std::string to_text(std::span<const LocatedScan> scans, const ndt::PlanView& plan);

}  // namespace landfix::tools
