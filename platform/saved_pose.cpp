#include "platform/saved_pose.hpp"

#include <limits>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "platform/atomic_file.hpp"
#include "platform/toml_section.hpp"

namespace landfix::platform {

void save_pose(const std::filesystem::path& path, const SavedPose& saved) {
  const ndt::RollPitchYaw angles = ndt::to_roll_pitch_yaw(saved.at.pose.linear());
  const Eigen::Vector3d& place_m = saved.at.pose.translation();
  AtomicFile file(path);
  file.write(
      fmt::format("# Where landfixd last was sure of being; a restart resumes from here.\n"
                  "[saved]\n"
                  "pose = [{:.4f}, {:.4f}, {:.4f}, {:.5f}, {:.5f}, {:.5f}]\n"
                  "stamp_utc_ns = {}\n"
                  "map_checksum = {}\n",
                  place_m.x(), place_m.y(), place_m.z(), angles.roll_rad / ndt::kRadians_per_deg,
                  angles.pitch_rad / ndt::kRadians_per_deg, angles.yaw_rad / ndt::kRadians_per_deg,
                  saved.at.stamp_utc_ns, saved.map_checksum));
  file.commit();
}

SavedPose read_saved_pose(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_file(path);
  toml::table root;
  try {
    root = toml::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
                       path.string());
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", place(path, error.source()), error.description()));
  }
  TomlSection section(path, root, "saved");
  section.require("pose");
  section.require("map_checksum");
  SavedPose saved;
  section.read("pose", saved.at.pose);
  section.read<std::int64_t>("stamp_utc_ns", saved.at.stamp_utc_ns,
                             {0, std::numeric_limits<std::int64_t>::max()});
  section.read<std::uint32_t>("map_checksum", saved.map_checksum,
                              {0, std::numeric_limits<std::uint32_t>::max()});
  section.finish();
  return saved;
}

}  // namespace landfix::platform
