#include "tools/simulator/route.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "platform/atomic_file.hpp"
#include "tools/simulator/embedded_routes.hpp"
#include "tools/simulator/table_reader.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr double kShortestDrive_m = 20.0;
constexpr double kClosestNiches_m = 10.0;
constexpr double kSmallestYard_m = 25.0;     // from the pavement to a block's middle
constexpr double kLongestRoute_m = 5'000.0;  // the work of surveying the land around grows with its cube

RoadProfile read_road(TableReader reader) {
  RoadProfile road;
  road.lanes = reader.integer("lanes", road.lanes, 1, 8);
  road.lane_width_m = reader.number("lane_width_m", road.lane_width_m, {2.0, 6.0});
  road.parking_width_m = reader.number("parking_width_m", road.parking_width_m, {0.0, 4.0});
  road.pavement_width_m = reader.number("pavement_width_m", road.pavement_width_m, {0.5, 8.0});
  road.kerb_m = reader.number("kerb_m", road.kerb_m, {0.0, 0.3});
  road.cross_fall = reader.number("cross_fall", road.cross_fall, {0.0, 0.08});
  reader.refuse_unknown_keys();
  if (road.lanes > 1 && road.lanes % 2 != 0) reader.fail("lanes must be 1 or even");
  return road;
}

Scenery read_scenery(TableReader reader) {
  Scenery scenery;
  const auto density = [&reader](std::string_view key, double& value, double most) {
    value = reader.number(key, value, {0.0, most});
  };
  density("buildings_per_100m", scenery.buildings, 40.0);
  density("trees_per_100m", scenery.trees, 100.0);
  density("poles_per_100m", scenery.poles, 100.0);
  density("signs_per_100m", scenery.signs, 100.0);
  density("boundaries_per_100m", scenery.boundaries, 40.0);
  density("side_streets_per_100m", scenery.side_streets, 4.0);
  density("parked_cars_per_100m", scenery.parked_cars, 40.0);
  density("moving_cars_per_100m", scenery.moving_cars, 10.0);
  scenery.building_setback_m = reader.number("building_setback_m", scenery.building_setback_m, {0.0, 30.0});
  scenery.building_height_m = reader.number("building_height_m", scenery.building_height_m, {3.0, 40.0});
  reader.refuse_unknown_keys();
  return scenery;
}

LandProfile read_land(TableReader reader) {
  LandProfile land;
  land.reach_m = reader.number("reach_m", land.reach_m, {0.0, 300.0});
  land.roughness = reader.number("roughness", land.roughness, {0.0, 3.0});
  reader.refuse_unknown_keys();
  return land;
}

SurveyPlan read_survey(TableReader reader) {
  SurveyPlan plan;
  plan.reach_m = reader.number("reach_m", plan.reach_m, {10.0, 300.0});
  plan.spacing_m = reader.number("spacing_m", plan.spacing_m, {0.03, 1.0});
  plan.coarsening = reader.number("coarsening", plan.coarsening, {0.0, 0.1});
  reader.refuse_unknown_keys();
  return plan;
}

Tunnel read_tunnel(TableReader reader) {
  Tunnel tunnel;
  tunnel.wall_height_m = reader.number("wall_height_m", tunnel.wall_height_m, {0.5, 10.0});
  tunnel.niche_spacing_m = reader.number("niche_spacing_m", tunnel.niche_spacing_m, {0.0, kLongestRoute_m});
  if (tunnel.niche_spacing_m > 0.0 && tunnel.niche_spacing_m < kClosestNiches_m) {
    reader.fail("niche_spacing_m",
                fmt::format("niche_spacing_m must be 0 (none) or at least {} m", kClosestNiches_m));
  }
  reader.refuse_unknown_keys();
  return tunnel;
}

City read_city(TableReader reader, const RoadProfile& road) {
  City city;
  city.side_m = reader.number("side_m", city.side_m, {100.0, 2'000.0});
  city.columns = reader.integer("columns", city.columns, 1, 40);
  city.rows = reader.integer("rows", city.rows, 1, 40);
  city.west_m = reader.number("west_m", {-2'000.0, 2'000.0});
  city.south_m = reader.number("south_m", {-2'000.0, 2'000.0});
  reader.refuse_unknown_keys();
  const double block_m =
      city.side_m / static_cast<double>(std::max(city.columns, city.rows)) - 2.0 * road.half_width_m();
  const double least_m = 2.0 * (road.pavement_width_m + kSmallestYard_m);
  if (block_m < least_m) {
    reader.fail(fmt::format("the blocks are {:.1f} m long or wide; houses need {:.1f} m", block_m, least_m));
  }
  return city;
}

RouteSegment read_segment(TableReader reader, double sharpest_1pm) {
  RouteSegment segment;
  segment.length_m = reader.number("length_m", {1.0, kLongestRoute_m});
  if (reader.has("turn_deg") && reader.has("curvature_1pm")) {
    reader.fail("give turn_deg or curvature_1pm, not both");
  }
  const double turn_deg = reader.number("turn_deg", 0.0, {-360.0, 360.0});
  segment.curvature_1pm = reader.number("curvature_1pm", 0.0, {-1.0, 1.0});
  if (turn_deg != 0.0) segment.curvature_1pm = turn_deg * std::numbers::pi / 180.0 / segment.length_m;
  segment.grade = reader.number("grade", 0.0, {-0.25, 0.25});
  segment.speed_mps = reader.number("speed_kmh", {3.0, 130.0}) / 3.6;
  reader.refuse_unknown_keys();
  if (std::abs(segment.curvature_1pm) > sharpest_1pm) {
    reader.fail(fmt::format("this turn has a radius of {:.1f} m, it needs {:.1f} m",
                            1.0 / std::abs(segment.curvature_1pm), 1.0 / sharpest_1pm));
  }
  return segment;
}

/// Where the inner verge of a curve would fold onto itself; where there is none, what a car can turn.
double sharpest_curvature_1pm(const Route& route) {
  constexpr double kVergeAndMargin_m = 8.0;
  constexpr double kTurningRadius_m = 6.0;
  if (route.city) return 1.0 / kTurningRadius_m;
  const RoadProfile& road = route.road;
  return 1.0 /
         (road.half_width_m() + road.pavement_width_m + std::abs(road.centre_offset_m()) + kVergeAndMargin_m);
}

}  // namespace

double Route::length_m() const noexcept {
  return std::accumulate(segments.begin(), segments.end(), 0.0,
                         [](double sum, const RouteSegment& segment) { return sum + segment.length_m; });
}

Route parse_route(std::string_view text, const std::string& file) {
  toml::table table;
  try {
    table = toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const toml::source_position where = error.source().begin;
    throw std::runtime_error(
        fmt::format("{}:{}:{}: {}", file, where.line, where.column, error.description()));
  }
  TableReader reader(table, file);
  Route route;
  route.name = file;
  route.seed = static_cast<std::uint64_t>(reader.integer("seed", 1, 0, std::int64_t{1} << 53));
  route.heading_deg = reader.number("heading_deg", 0.0, {-360.0, 360.0});
  route.road = read_road(reader.table("road"));
  route.scenery = read_scenery(reader.table("scenery"));
  if (auto part = reader.optional_table("land")) route.land = read_land(std::move(*part));
  if (auto part = reader.optional_table("survey")) route.survey = read_survey(std::move(*part));
  if (auto part = reader.optional_table("tunnel")) route.tunnel = read_tunnel(std::move(*part));
  if (auto part = reader.optional_table("city")) route.city = read_city(std::move(*part), route.road);
  if (route.city && (route.tunnel || reader.has("land"))) {
    reader.fail("city", "a [city] fills its square: beside it there is no [tunnel] and no [land]");
  }
  for (TableReader& segment : reader.tables("segment")) {
    route.segments.push_back(read_segment(std::move(segment), sharpest_curvature_1pm(route)));
  }
  reader.refuse_unknown_keys();
  if (route.length_m() < kShortestDrive_m || route.length_m() > kLongestRoute_m) {
    reader.fail(fmt::format("the segments add up to {} m; a route has {} m to {} m", route.length_m(),
                            kShortestDrive_m, kLongestRoute_m));
  }
  return route;
}

std::vector<std::string> route_names() {
  std::vector<std::string> names;
  for (const EmbeddedRoute& route : kEmbeddedRoutes) names.emplace_back(route.name);
  return names;
}

Route load_route(const std::string& name_or_file) {
  for (const EmbeddedRoute& route : kEmbeddedRoutes) {
    if (route.name == name_or_file) return parse_route(route.toml, name_or_file);
  }
  if (!std::filesystem::is_regular_file(name_or_file)) {
    throw std::invalid_argument(fmt::format("there is no route '{}': give a TOML file or one of {}",
                                            name_or_file, fmt::join(route_names(), ", ")));
  }
  const std::vector<std::byte> bytes = platform::read_file(name_or_file);
  return parse_route({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name_or_file);
}

Route shortened(Route route, double length_m) {
  if (!(length_m >= kShortestDrive_m && length_m <= route.length_m())) {
    throw std::invalid_argument(fmt::format("route {} can be driven for {} m to {} m, not for {} m",
                                            route.name, kShortestDrive_m, route.length_m(), length_m));
  }
  double left_m = length_m;
  std::vector<RouteSegment> kept;
  for (RouteSegment segment : route.segments) {
    segment.length_m = std::min(segment.length_m, left_m);
    left_m -= segment.length_m;
    if (segment.length_m > 0.0) kept.push_back(segment);
  }
  route.segments = std::move(kept);
  return route;
}

}  // namespace landfix::tools::simulator
