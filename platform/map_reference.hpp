// What a receiver of poses is told of the map that they are in.
#pragma once

#include <cstdint>
#include <optional>

#include "platform/map_projection.hpp"
#include "platform/pose_report.hpp"

namespace landfix::platform {

/// Positions are sent relative to one of the map's origins, as coordinates of MGRS are larger than what
/// LOC_POSITION holds. The origins are a grid, so that a number is enough to tell which.
inline constexpr double kMapOriginStep_m = 8000.0;

/// Of the origin that is nearest.
[[nodiscard]] std::uint16_t map_origin_near(const Eigen::Vector3d& position_m) noexcept;
[[nodiscard]] Eigen::Vector3d map_origin_m(std::uint16_t origin) noexcept;

/// The codes are LOC_MAP's (pose_frame_table.hpp); 0: unknown.
struct MapReference {
  std::uint16_t hash = 0;    ///< tells one map from another
  std::uint16_t origin = 0;  ///< of positions, for as long as the map is in use
  std::uint16_t projector = 0;
  std::uint16_t datum = 0;
  std::uint16_t utm_zone = 0;  ///< 1 to 60; 0: not projected by one
  std::optional<MapProjection> projection{};

  /// Adds all of it to the report, whose position is the map's: latitude and longitude, and relative to the
  /// origin it is afterwards.
  void add_to(PoseReport& report) const noexcept;
};

}  // namespace landfix::platform
