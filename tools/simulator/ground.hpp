// The ground: a road with cross-fall and kerbs, pavements, verges, and the land around, or a city's streets
// and blocks; none of it quite flat.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "tools/simulator/mesh.hpp"
#include "tools/simulator/path.hpp"
#include "tools/simulator/route.hpp"
#include "tools/simulator/street_grid.hpp"

namespace landfix::tools::simulator {

/// Where a kerb is lowered and nothing is built.
struct SideStreet {
  double station_m = 0.0;
  double width_m = 8.0;
  bool left = false;
};

/// A place relative to the line that is driven.
struct RoadPosition {
  double station_m = 0.0;
  double offset_m = 0.0;  ///< positive to the left of the vehicle's lane centre
};

class Ground {
 public:
  /// `path` must outlive the ground.
  Ground(const Path& path, const Route& route, std::vector<SideStreet> side_streets, std::uint64_t seed);

  [[nodiscard]] const Path& path() const noexcept { return path_; }
  [[nodiscard]] const RoadProfile& road() const noexcept { return road_; }
  [[nodiscard]] const std::vector<SideStreet>& side_streets() const noexcept { return side_streets_; }
  /// In a city all of the ground.
  [[nodiscard]] const std::optional<StreetGrid>& streets() const noexcept { return streets_; }
  /// Distance from the middle of the road to where its cross-section ends and the land begins.
  [[nodiscard]] double corridor_half_width_m() const noexcept;

  /// Height of the ground, frame `map`.
  [[nodiscard]] double height_m(const RoadPosition& place) const noexcept;
  [[nodiscard]] double height_m(const Eigen::Vector2d& xy_m) const noexcept;
  [[nodiscard]] Eigen::Vector3d point_m(const RoadPosition& place) const noexcept;

  /// The nearest place on the line.
  [[nodiscard]] RoadPosition project(const Eigen::Vector2d& xy_m) const noexcept;
  /// From the middle of the road; in a city, of the nearest street.
  [[nodiscard]] double distance_to_road_m(const Eigen::Vector2d& xy_m) const noexcept;
  /// The same; infinity where the nearest place on the road is more than `margin_m` before the start of the
  /// drive or after its end. In a city all streets count.
  [[nodiscard]] double distance_to_drive_m(const Eigen::Vector2d& xy_m, double margin_m) const noexcept;
  [[nodiscard]] bool in_side_street(double station_m, bool left, double margin_m) const noexcept;

  /// A vehicle at rest: origin on the ground between the rear wheels, x towards the front axle, tilted as the
  /// ground under its wheels. `turn_rad`: its heading relative to the road's.
  [[nodiscard]] Place vehicle_place(const RoadPosition& place, double turn_rad) const noexcept;

  [[nodiscard]] Mesh mesh() const;

 private:
  /// The land beyond the road, on a regular grid.
  struct Land {
    Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();
    std::size_t columns = 0;
    std::size_t rows = 0;
    std::vector<float> height_m;
    std::vector<float> distance_m;  ///< to the middle of the road
  };

  [[nodiscard]] double profile_m(double station_m, double across_m) const noexcept;
  [[nodiscard]] double kerb_m(double station_m, bool left) const noexcept;
  [[nodiscard]] double road_height_m(const PathPoint& point, double station_m,
                                     double across_m) const noexcept;
  [[nodiscard]] double street_height_m(const Eigen::Vector2d& xy_m) const noexcept;
  [[nodiscard]] double land_height_m(const Eigen::Vector2d& xy_m) const noexcept;
  [[nodiscard]] Eigen::Vector2d land_node_m(std::size_t column, std::size_t row) const noexcept;
  [[nodiscard]] bool beyond_the_ends(const Eigen::Vector2d& xy_m) const noexcept;
  void survey_land();
  void add_road(Mesh& mesh) const;
  void add_land(Mesh& mesh) const;
  void add_streets(Mesh& mesh) const;

  const Path& path_;
  RoadProfile road_;
  LandProfile land_profile_;
  std::optional<StreetGrid> streets_;
  std::vector<SideStreet> side_streets_;
  double phase_rad_;  ///< of the unevenness, so that each seed has its own
  std::vector<PathPoint> coarse_;
  Land land_;
};

}  // namespace landfix::tools::simulator
