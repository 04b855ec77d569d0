// The land beyond the road: a grid of heights that follow the road near it.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tools/simulator/ground.hpp"
#include "tools/simulator/unevenness.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr double kLandCell_m = 1.0;
// Land is uneven by decimetres.
constexpr std::array kLandWaves{Wave{0.10, 23.0, 0.4}, Wave{0.05, 11.0, 1.9}, Wave{0.03, 6.3, 2.8},
                                Wave{0.015, 3.7, 1.2}};

}  // namespace

Eigen::Vector2d Ground::land_node_m(std::size_t column, std::size_t row) const noexcept {
  return land_.origin_m +
         kLandCell_m * Eigen::Vector2d(static_cast<double>(column), static_cast<double>(row));
}

void Ground::survey_land() {
  Eigen::AlignedBox2d box;
  for (const PathPoint& point : coarse_) box.extend(Eigen::Vector2d(point.position_m.head<2>()));
  land_.origin_m = box.min().array() - land_profile_.reach_m;
  const Eigen::Vector2d size_m = box.sizes().array() + 2.0 * land_profile_.reach_m;
  land_.columns = static_cast<std::size_t>(size_m.x() / kLandCell_m) + 2;
  land_.rows = static_cast<std::size_t>(size_m.y() / kLandCell_m) + 2;
  land_.height_m.assign(land_.columns * land_.rows, 0.0F);
  land_.distance_m.assign(land_.columns * land_.rows, std::numeric_limits<float>::infinity());
  for (std::size_t row = 0; row < land_.rows; ++row) {
    for (std::size_t column = 0; column < land_.columns; ++column) {
      const Eigen::Vector2d xy_m = land_node_m(column, row);
      // Inverse distance weighting: the land is as high as the road near it.
      double weights = 0.0;
      double height_m = 0.0;
      double nearest_m2 = std::numeric_limits<double>::infinity();
      for (const PathPoint& point : coarse_) {
        const double distance_m2 = (point.position_m.head<2>() - xy_m).squaredNorm();
        const double inverse = 1.0 / (distance_m2 + 1.0);
        const double weight = inverse * inverse * inverse;
        weights += weight;
        height_m += weight * point.position_m.z();
        nearest_m2 = std::min(nearest_m2, distance_m2);
      }
      const std::size_t node = row * land_.columns + column;
      land_.height_m[node] = static_cast<float>(height_m / weights +
                                                land_profile_.roughness *
                                                    unevenness_m(kLandWaves, xy_m.x(), xy_m.y(), phase_rad_));
      if (nearest_m2 < land_profile_.reach_m * land_profile_.reach_m) {
        const double distance_m = distance_to_road_m(xy_m);
        land_.distance_m[node] = static_cast<float>(
            beyond_the_ends(xy_m) ? std::max(distance_m, corridor_half_width_m()) : distance_m);
      }
    }
  }
}

double Ground::land_height_m(const Eigen::Vector2d& xy_m) const noexcept {
  const Eigen::Vector2d cell = (xy_m - land_.origin_m) / kLandCell_m;
  const double x = std::clamp(cell.x(), 0.0, static_cast<double>(land_.columns) - 1.001);
  const double y = std::clamp(cell.y(), 0.0, static_cast<double>(land_.rows) - 1.001);
  const auto column = static_cast<std::size_t>(x);
  const auto row = static_cast<std::size_t>(y);
  const double u = x - static_cast<double>(column);
  const double v = y - static_cast<double>(row);
  const auto at = [this](std::size_t c, std::size_t r) {
    return static_cast<double>(land_.height_m[r * land_.columns + c]);
  };
  return std::lerp(std::lerp(at(column, row), at(column + 1, row), u),
                   std::lerp(at(column, row + 1), at(column + 1, row + 1), u), v);
}

bool Ground::beyond_the_ends(const Eigen::Vector2d& xy_m) const noexcept {
  constexpr double kSeam_m = 1.0;
  const RoadPosition place = project(xy_m);
  const PathPoint point = path_.at(place.station_m);
  return std::abs((xy_m - point.position_m.head<2>()).dot(point.forward())) > kSeam_m;
}

}  // namespace landfix::tools::simulator
