#include "platform/map_projection.hpp"

#include <cmath>

#include "ndt/pose.hpp"

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

MapPlace place_on(const TransverseMercatorMap& map, const GeodeticPosition& position) noexcept {
  MapPlace place;
  double convergence_deg = 0.0;
  double scale = 1.0;
  map.projection.Forward(map.central_meridian_deg, position.latitude_deg, position.longitude_deg,
                         place.position_m.x(), place.position_m.y(), convergence_deg, scale);
  place.position_m.z() = position.altitude_m;
  place.position_m -= map.false_origin_m;
  place.north_rad = (90.0 + convergence_deg) * ndt::kRadians_per_deg;
  return place;
}

MapPlace place_on(const LocalCartesianMap& map, const GeodeticPosition& position) noexcept {
  constexpr double kNorth_deg = 1e-5;  // about a metre
  MapPlace place;
  map.plane.Forward(position.latitude_deg, position.longitude_deg, position.altitude_m, place.position_m.x(),
                    place.position_m.y(), place.position_m.z());
  Eigen::Vector3d north_m;
  map.plane.Forward(position.latitude_deg + kNorth_deg, position.longitude_deg, position.altitude_m,
                    north_m.x(), north_m.y(), north_m.z());
  const Eigen::Vector3d way_m = north_m - place.position_m;
  place.north_rad = std::atan2(way_m.y(), way_m.x());
  return place;
}

}  // namespace

GeodeticPosition to_geodetic(const MapProjection& projection, const Eigen::Vector3d& position_m) noexcept {
  if (const auto* map = std::get_if<TransverseMercatorMap>(&projection)) return project(*map, position_m);
  return project(*std::get_if<LocalCartesianMap>(&projection), position_m);
}

MapPlace to_map(const MapProjection& projection, const GeodeticPosition& position) noexcept {
  if (const auto* map = std::get_if<TransverseMercatorMap>(&projection)) return place_on(*map, position);
  return place_on(*std::get_if<LocalCartesianMap>(&projection), position);
}

}  // namespace landfix::platform
