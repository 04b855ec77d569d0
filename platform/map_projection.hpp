// Between a map's x, y, z and latitude, longitude and altitude, as the map was projected.
#pragma once

#include <variant>

#include <Eigen/Core>
#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/TransverseMercator.hpp>

namespace landfix::platform {

/// On the ellipsoid of WGS84; the altitude is above the map's vertical datum.
struct GeodeticPosition {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double altitude_m = 0.0;
};

/// MGRS, UTM and all that is made like them: where the projection's easting and northing, and the altitude,
/// are 0 in the map.
struct TransverseMercatorMap {
  GeographicLib::TransverseMercator projection;
  double central_meridian_deg = 0.0;
  Eigen::Vector3d false_origin_m = Eigen::Vector3d::Zero();  ///< added to the map's x, y, z
};

/// A plane that touches the ellipsoid; x east, y north.
struct LocalCartesianMap {
  GeographicLib::LocalCartesian plane;
};

using MapProjection = std::variant<TransverseMercatorMap, LocalCartesianMap>;

[[nodiscard]] GeodeticPosition to_geodetic(const MapProjection& projection,
                                           const Eigen::Vector3d& position_m) noexcept;

/// A place of the earth in the map.
struct MapPlace {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double north_rad = 0.0;  ///< heading there of true north, counter-clockwise from x
};

[[nodiscard]] MapPlace to_map(const MapProjection& projection, const GeodeticPosition& position) noexcept;

}  // namespace landfix::platform
