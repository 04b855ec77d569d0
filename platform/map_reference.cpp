#include "platform/map_reference.hpp"

#include "platform/pose_frame_table.hpp"

namespace landfix::platform {

void MapReference::add_to(PoseReport& report) const noexcept {
  report.map_hash = hash;
  report.map_projector = projector;
  report.map_datum = datum;
  report.frames_version = kFramesVersion;
  if (!projection) return;
  report.utm_zone = utm_zone;
  const Eigen::Vector3d position_m(report.x_m, report.y_m, report.z_m);
  if (!position_m.allFinite()) return;
  const GeodeticPosition position = to_geodetic(*projection, position_m);
  report.latitude_deg = position.latitude_deg;
  report.longitude_deg = position.longitude_deg;
}

}  // namespace landfix::platform
