// The line that the vehicle drives, in three dimensions, with no jump in heading, slope or curvature.
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "tools/simulator/route.hpp"

namespace landfix::tools::simulator {

/// Frame `map`: its origin is where the drive begins, z is up.
struct PathPoint {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double heading_rad = 0.0;
  double slope_rad = 0.0;  ///< positive uphill
  double curvature_1pm = 0.0;

  /// Unit vectors in the horizontal plane: along the road, and to its left.
  [[nodiscard]] Eigen::Vector2d forward() const noexcept;
  [[nodiscard]] Eigen::Vector2d left() const noexcept;
};

/// Stations are metres along the line. The road goes on straight and level before the route and after it, as
/// far as a LiDAR sees.
class Path {
 public:
  explicit Path(const Route& route);

  /// A station beyond the ends gives the end.
  [[nodiscard]] PathPoint at(double station_m) const noexcept;
  [[nodiscard]] double first_station_m() const noexcept;
  [[nodiscard]] double last_station_m() const noexcept;
  /// Of the drive, which begins at station 0.
  [[nodiscard]] double length_m() const noexcept { return length_m_; }

 private:
  std::vector<PathPoint> knots_;
  double length_m_;
};

/// Mean over 2 * `half_width` + 1 neighbours; beyond the ends the end value goes on.
[[nodiscard]] std::vector<double> moving_mean(const std::vector<double>& values, std::size_t half_width);

}  // namespace landfix::tools::simulator
