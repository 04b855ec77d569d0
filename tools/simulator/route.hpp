// A route: the road that the vehicle drives and what surrounds it, read from a TOML file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace landfix::tools::simulator {

/// A stretch of road with one curvature, grade and speed; transitions between stretches are smoothed.
struct RouteSegment {
  double length_m = 0.0;
  double curvature_1pm = 0.0;  ///< positive turns left
  double grade = 0.0;          ///< rise over run, positive uphill
  double speed_mps = 0.0;      ///< the most that is driven here
};

/// The cross-section. Traffic keeps to the right; the vehicle drives in the rightmost lane.
struct RoadProfile {
  std::int64_t lanes = 2;  ///< both directions together; 1 is a path without oncoming traffic
  double lane_width_m = 3.25;
  double parking_width_m = 0.0;  ///< strip for parked cars on either side
  double pavement_width_m = 2.0;
  double kerb_m = 0.12;      ///< how much higher the pavement is
  double cross_fall = 0.02;  ///< from the middle of the road to its edges

  [[nodiscard]] double half_width_m() const noexcept {
    return 0.5 * static_cast<double>(lanes) * lane_width_m + parking_width_m;
  }
  /// From the vehicle's lane to the middle of the road, positive to the left.
  [[nodiscard]] double centre_offset_m() const noexcept {
    return 0.5 * (static_cast<double>(lanes) - 1.0) * lane_width_m;
  }
};

/// How much of everything, per 100 m of road, both sides together.
struct Scenery {
  double buildings = 8.0;
  double trees = 10.0;
  double poles = 6.0;
  double signs = 2.0;
  double boundaries = 4.0;  ///< hedges, fences and garden walls
  double side_streets = 0.8;
  double parked_cars = 8.0;
  double moving_cars = 1.0;
  double building_setback_m = 3.0;  ///< mean distance from the pavement
  double building_height_m = 9.0;   ///< mean
};

/// What lies beyond the pavements.
struct LandProfile {
  double reach_m = 70.0;   ///< from the middle of the road; 0: there is none, and no verge
  double roughness = 1.0;  ///< 1: uneven by decimetres
};

/// How far from the road, and how densely, a surveyor measures.
struct SurveyPlan {
  double reach_m = 60.0;
  double spacing_m = 0.10;    ///< side of the square that a point stands for, near the road
  double coarsening = 0.012;  ///< metres of spacing for each metre away
};

/// Upright walls at the outer edges of the pavements and a semicircular vault on them, over the whole road.
struct Tunnel {
  double wall_height_m = 2.2;
  double niche_spacing_m = 0.0;  ///< of the emergency niches in the right wall; 0: none
};

/// A square full of streets, each with the road's profile, and blocks of houses. Its edges are the middles of
/// streets.
struct City {
  double side_m = 1'000.0;
  std::int64_t columns = 8;  ///< of blocks, along the map's x axis
  std::int64_t rows = 10;
  double west_m = 0.0;  ///< the south-western corner; the drive begins at the map's origin
  double south_m = 0.0;
};
/// The rounding of a kerb at a crossing has a radius this much longer than the pavement is wide.
inline constexpr double kCornerBeyondPavement_m = 3.0;

struct Route {
  std::string name;
  std::uint64_t seed = 1;
  double heading_deg = 0.0;  ///< at the start, counter-clockwise from the map's x axis
  RoadProfile road;
  Scenery scenery;
  LandProfile land;
  SurveyPlan survey;
  std::optional<Tunnel> tunnel;
  std::optional<City> city;
  std::vector<RouteSegment> segments;

  [[nodiscard]] double length_m() const noexcept;
};

/// `file` is named in errors. Throws std::runtime_error with file, line and column.
[[nodiscard]] Route parse_route(std::string_view text, const std::string& file);

/// A route that is part of the program (`route_names`), or else a file. Throws std::invalid_argument where
/// there is neither, std::runtime_error where the file is wrong.
[[nodiscard]] Route load_route(const std::string& name_or_file);
[[nodiscard]] std::vector<std::string> route_names();

/// The first `length_m` of a route. Throws std::invalid_argument if the route is shorter, or if the length
/// is too short to drive off and stop.
[[nodiscard]] Route shortened(Route route, double length_m);

}  // namespace landfix::tools::simulator
