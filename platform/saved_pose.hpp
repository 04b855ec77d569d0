// The last good pose, kept on disk so that a restart resumes where the vehicle stood.
#pragma once

#include <cstdint>
#include <filesystem>

#include "ndt/pose.hpp"

namespace landfix::platform {

struct SavedPose {
  ndt::StampedPose at;             ///< map <- vehicle
  std::uint32_t map_checksum = 0;  ///< of the map that it is in
};

/// Replaces the file as a whole. Throws std::runtime_error with the path and the reason, the old one left.
void save_pose(const std::filesystem::path& path, const SavedPose& saved);

/// Throws std::runtime_error with the path and the reason: absent, or not such a file.
[[nodiscard]] SavedPose read_saved_pose(const std::filesystem::path& path);

}  // namespace landfix::platform
