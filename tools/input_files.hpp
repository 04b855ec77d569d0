// What several commands read: maps, scans, poses on the command line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "ndt/map_image.hpp"
#include "ndt/pose.hpp"
#include "ndt/scan_filter.hpp"

namespace landfix::tools {

using ndt::kRadians_per_deg;

/// Cells that a map has room for unless more are asked for: a city of a square kilometre at 1 m.
inline constexpr std::size_t kMapCapacity = 16'000'000;

/// Ranges between which points of a scan count; those of the reference study by default.
struct RangeLimits {
  double min_m = 3.0;
  double max_m = 200.0;
};

/// A validated map, mapped into memory. Throws std::runtime_error that says what is wrong with the file.
[[nodiscard]] ndt::MapImage load_map_file(const std::filesystem::path& path);

/// The finite points of a PCD file within the limits, in the frame it gives them in.
[[nodiscard]] std::vector<Eigen::Vector3f> load_scan(const std::filesystem::path& path,
                                                     const RangeLimits& limits);

/// The file that `path` is, or the PCD files of the folder that it is: those that Autoware's metadata lists
/// if the folder has it, else all by name. Throws UsageError where the folder has none, std::runtime_error
/// where there is nothing of that name.
[[nodiscard]] std::vector<std::filesystem::path> list_clouds(const std::filesystem::path& path);

/// Those of several. Throws as above, and UsageError where one is given twice: its points would count double.
[[nodiscard]] std::vector<std::filesystem::path> list_clouds_once(const std::vector<std::string>& paths);

/// Calls `visit` with each finite point [m] and shows how far it is. Memory does not follow the clouds' size.
void visit_clouds(const std::vector<std::filesystem::path>& clouds,
                  const std::function<void(const Eigen::Vector3d&)>& visit);

/// --min-range and --max-range.
void add_range_options(CLI::App& command, RangeLimits& limits);

/// --filter, --entropy-share and --leaf.
void add_filter_options(CLI::App& command, ndt::FilterSettings& filter);

/// What stands for the rings of a cloud, which may have none, or another origin than the sensor's: elevations
/// from the origin, in steps of 1/3 deg.
[[nodiscard]] std::vector<std::uint16_t> elevation_steps(std::span<const Eigen::Vector3f> points_m);

/// An option that takes X,Y,Z,ROLL_DEG,PITCH_DEG,YAW_DEG.
CLI::Option* add_pose_option(CLI::App& command, const std::string& name, std::optional<ndt::Pose>& pose,
                             const std::string& description);

/// [x y z roll_deg pitch_deg yaw_deg]
[[nodiscard]] nlohmann::json pose_to_json(const ndt::Pose& pose);

}  // namespace landfix::tools
