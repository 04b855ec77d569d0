// A point map seen from above: cells, shaded by how much stands on them.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace landfix::tools {

inline constexpr std::size_t kShades = 4;

/// Paths of an SVG, one a shade (0: level ground, 3: higher than a storey). Their units are cells: x to the
/// right and y down from the upper left corner of the area.
struct MapRaster {
  double cell_m = 1.0;
  std::vector<std::string> paths;
};

/// Cells are as small as the points allow without gaps, and as the picture's size does. Points outside of
/// `area_m` and points that are not finite are left out.
[[nodiscard]] MapRaster rasterise(std::span<const Eigen::Vector3f> points_m,
                                  const Eigen::AlignedBox2d& area_m);

}  // namespace landfix::tools
