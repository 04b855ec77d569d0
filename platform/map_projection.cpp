#include "platform/map_projection.hpp"

namespace landfix::platform {
namespace {

GeodeticPosition project(const TransverseMercatorMap& map, const Eigen::Vector3d& position_m) noexcept {
  const Eigen::Vector3d at_m = position_m + map.false_origin_m;
  GeodeticPosition result{.altitude_m = at_m.z()};
  map.projection.Reverse(map.central_meridian_deg, at_m.x(), at_m.y(), result.latitude_deg,
                         result.longitude_deg);
  return result;
}

GeodeticPosition project(const LocalCartesianMap& map, const Eigen::Vector3d& position_m) noexcept {
  GeodeticPosition result;
  map.plane.Reverse(position_m.x(), position_m.y(), position_m.z(), result.latitude_deg, result.longitude_deg,
                    result.altitude_m);
  return result;
}

}  // namespace

GeodeticPosition to_geodetic(const MapProjection& projection, const Eigen::Vector3d& position_m) noexcept {
  if (const auto* map = std::get_if<TransverseMercatorMap>(&projection)) return project(*map, position_m);
  return project(*std::get_if<LocalCartesianMap>(&projection), position_m);
}

}  // namespace landfix::platform
