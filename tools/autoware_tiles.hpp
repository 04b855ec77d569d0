// Autoware's point cloud maps: tiles in files of their own, and a YAML file that lists them:
//
//   x_resolution: 20.0
//   y_resolution: 20.0
//   A.pcd: [1200, 2500]   # covers 1200 <= x < 1220, 2500 <= y < 2520
#pragma once

#include <filesystem>
#include <vector>

namespace landfix::tools {

inline constexpr const char* kTileMetadataName = "pointcloud_map_metadata.yaml";

/// The files that `metadata` lists, in its order. They lie beside it or in the folder pointcloud_map or
/// pointcloud_map.pcd beside it. Throws std::runtime_error with line and column where the file is not as
/// above, and with the name of a tile that is not there.
[[nodiscard]] std::vector<std::filesystem::path> list_tiles(const std::filesystem::path& metadata);

}  // namespace landfix::tools
