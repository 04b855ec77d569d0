// What a receiver of poses is told of the map that they are in.
#pragma once

#include <cstdint>
#include <optional>

#include "platform/map_projection.hpp"
#include "platform/pose_report.hpp"

namespace landfix::platform {

/// The codes are LOC_MAP's (pose_frame_table.hpp); 0: unknown.
struct MapReference {
  std::uint16_t hash = 0;  ///< tells one map from another
  std::uint16_t projector = 0;
  std::uint16_t datum = 0;
  std::uint16_t utm_zone = 0;  ///< 1 to 60; 0: not projected by one
  std::optional<MapProjection> projection{};

  /// Adds all of it to the report; latitude and longitude, if there is a position.
  void add_to(PoseReport& report) const noexcept;
};

}  // namespace landfix::platform
