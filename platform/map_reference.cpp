#include "platform/map_reference.hpp"

#include <algorithm>
#include <cmath>

#include "platform/pose_frame_table.hpp"

namespace landfix::platform {
namespace {

constexpr unsigned kOriginBits = 4;  // of each axis
constexpr std::uint16_t kOriginMask = (1U << kOriginBits) - 1;

[[nodiscard]] std::uint16_t steps_near(double coordinate_m) noexcept {
  return static_cast<std::uint16_t>(
      std::clamp(std::round(coordinate_m / kMapOriginStep_m), 0.0, double{kOriginMask}));
}

}  // namespace

std::uint16_t map_origin_near(const Eigen::Vector3d& position_m) noexcept {
  return static_cast<std::uint16_t>(steps_near(position_m.x()) | steps_near(position_m.y()) << kOriginBits);
}

Eigen::Vector3d map_origin_m(std::uint16_t origin) noexcept {
  return kMapOriginStep_m * Eigen::Vector3d(origin & kOriginMask, origin >> kOriginBits & kOriginMask, 0.0);
}

void MapReference::add_to(PoseReport& report) const noexcept {
  report.map_hash = hash;
  report.map_origin = origin;
  report.map_projector = projector;
  report.map_datum = datum;
  report.frames_version = kFramesVersion;
  report.utm_zone = utm_zone;
  const Eigen::Vector3d position_m(report.x_m, report.y_m, report.z_m);
  if (projection && position_m.allFinite()) {
    const GeodeticPosition position = to_geodetic(*projection, position_m);
    report.latitude_deg = position.latitude_deg;
    report.longitude_deg = position.longitude_deg;
  }
  const Eigen::Vector3d origin_m = map_origin_m(origin);
  report.x_m -= origin_m.x();
  report.y_m -= origin_m.y();
}

}  // namespace landfix::platform
