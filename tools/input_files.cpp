#include "tools/input_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "ndt/map_file.hpp"
#include "ndt/pcd.hpp"
#include "platform/atomic_file.hpp"
#include "platform/mapped_file.hpp"
#include "tools/autoware_tiles.hpp"
#include "tools/command.hpp"

namespace landfix::tools {

ndt::MapImage load_map_file(const std::filesystem::path& path) {
  const auto file = std::make_shared<const platform::MappedFile>(path);
  if (!file->is_mapped()) return ndt::load_map(file->bytes(), path.string());
  file->populate();
  ndt::validate_map(file->bytes(), path.string());
  return {file->bytes(), file};
}

std::vector<Eigen::Vector3f> load_scan(const std::filesystem::path& path, const RangeLimits& limits) {
  std::vector<Eigen::Vector3f> points_m;
  ndt::visit_pcd_positions(platform::read_file(path), path.string(), [&](const Eigen::Vector3d& point_m) {
    const double range_m = point_m.norm();
    if (range_m >= limits.min_m && range_m <= limits.max_m) points_m.emplace_back(point_m.cast<float>());
  });
  return points_m;
}

std::vector<std::filesystem::path> list_clouds(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path))
    throw std::runtime_error(fmt::format("{}: no such file or folder", path.string()));
  if (!std::filesystem::is_directory(path)) return {path};
  if (std::filesystem::exists(path / kTileMetadataName)) return list_tiles(path / kTileMetadataName);
  std::vector<std::filesystem::path> clouds;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.is_regular_file() && entry.path().extension() == ".pcd") clouds.push_back(entry.path());
  }
  if (clouds.empty()) throw UsageError(fmt::format("{}: no .pcd file in this folder", path.string()));
  std::sort(clouds.begin(), clouds.end());
  return clouds;
}

std::vector<std::filesystem::path> list_clouds_once(const std::vector<std::string>& paths) {
  std::vector<std::filesystem::path> clouds;
  std::set<std::filesystem::path> known;
  for (const std::string& path : paths) {
    for (const std::filesystem::path& cloud : list_clouds(path)) {
      if (!known.insert(std::filesystem::canonical(cloud)).second)
        throw UsageError(fmt::format("--pcd: {} is given twice", cloud.string()));
      clouds.push_back(cloud);
    }
  }
  return clouds;
}

void visit_clouds(const std::vector<std::filesystem::path>& clouds,
                  const std::function<void(const Eigen::Vector3d&)>& visit) {
  constexpr std::uint64_t kPointsAtATime = 1 << 20;
  std::uint64_t points = 0;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const platform::MappedFile file(clouds[i]);
    ndt::visit_pcd_positions(file.bytes(), clouds[i].string(), [&](const Eigen::Vector3d& point_m) {
      visit(point_m);
      if (++points % kPointsAtATime != 0) return;
      file.drop_pages();
      show_progress(
          fmt::format("reading {} of {} clouds, {} million points", i + 1, clouds.size(), points >> 20));
    });
  }
  show_progress("");
}

void add_range_options(CLI::App& command, RangeLimits& limits) {
  command.add_option("--min-range", limits.min_m, "points nearer to the origin are left out [m]")
      ->check(in_range(0.0, 1e9))
      ->type_name("M")
      ->capture_default_str();
  command.add_option("--max-range", limits.max_m, "points farther from the origin are left out [m]")
      ->check(in_range(1e-9, 1e9))
      ->type_name("M")
      ->capture_default_str();
}

void add_filter_options(CLI::App& command, ndt::FilterSettings& filter) {
  std::map<std::string, ndt::FilterKind> kinds;
  for (const std::string_view name : ndt::kFilterNames) kinds.emplace(name, ndt::find_filter(name).value());
  command.add_option("--filter", filter.kind, "what is kept of the scan: voxel, ring or entropy")
      ->transform(one_of(kinds))
      ->type_name("KIND")
      ->default_str("voxel");
  command.add_option("--entropy-share", filter.entropy_share, "share of the cells that entropy keeps")
      ->check(in_range(0.01, 1.0))
      ->type_name("SHARE")
      ->capture_default_str();
  command.add_option("--leaf", filter.leaf_m, "edge of a cell of the scan's filter [m]")
      ->check(in_range(0.01, 100.0))
      ->type_name("M")
      ->capture_default_str();
}

std::vector<std::uint16_t> elevation_steps(std::span<const Eigen::Vector3f> points_m) {
  std::vector<std::uint16_t> steps;
  steps.reserve(points_m.size());
  for (const Eigen::Vector3f& p : points_m) {
    const double elevation_deg =
        static_cast<double>(std::atan2(p.z(), p.head<2>().norm())) / kRadians_per_deg;
    steps.push_back(static_cast<std::uint16_t>((elevation_deg + 90.0) * 3.0));
  }
  return steps;
}

CLI::Option* add_pose_option(CLI::App& command, const std::string& name, std::optional<ndt::Pose>& pose,
                             const std::string& description) {
  const auto parse = [&pose, name](const std::vector<std::string>& words) {
    std::array<double, 6> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!CLI::detail::lexical_cast(words[i], values[i]) || !std::isfinite(values[i])) {
        throw CLI::ValidationError(name, fmt::format("'{}' is not a number", words[i]));
      }
    }
    const auto& [x, y, z, roll_deg, pitch_deg, yaw_deg] = values;
    pose = ndt::make_pose({x, y, z}, {.roll_rad = roll_deg * kRadians_per_deg,
                                      .pitch_rad = pitch_deg * kRadians_per_deg,
                                      .yaw_rad = yaw_deg * kRadians_per_deg});
    return true;
  };
  return command.add_option(name, parse, description)
      ->delimiter(',')
      ->expected(6)
      ->type_size(1)
      ->type_name("X,Y,Z,ROLL_DEG,PITCH_DEG,YAW_DEG");
}

nlohmann::json pose_to_json(const ndt::Pose& pose) {
  const ndt::RollPitchYaw angles = ndt::to_roll_pitch_yaw(pose.linear());
  return {pose.translation().x(),
          pose.translation().y(),
          pose.translation().z(),
          angles.roll_rad / kRadians_per_deg,
          angles.pitch_rad / kRadians_per_deg,
          angles.yaw_rad / kRadians_per_deg};
}

}  // namespace landfix::tools
