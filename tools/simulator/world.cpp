#include "tools/simulator/world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/building.hpp"
#include "tools/simulator/car_model.hpp"
#include "tools/simulator/city.hpp"
#include "tools/simulator/footprint.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/street_furniture.hpp"
#include "tools/simulator/tunnel.hpp"
#include "tools/simulator/vegetation.hpp"

namespace landfix::tools::simulator {
namespace {

/// Puts things along the road, one kind after the other; what comes first keeps its place.
class WorldBuilder {
 public:
  WorldBuilder(const Route& route, const Ground& ground, std::uint64_t seed)
      : route_(route), ground_(ground), random_(seed, RandomStream::world) {}

  World build() {
    const Scenery& scenery = route_.scenery;
    world_.surveyed = ground_.mesh();
    if (route_.tunnel) add_tunnel(world_.surveyed, ground_, *route_.tunnel);
    if (ground_.streets()) {
      add_city(world_.surveyed, world_.parked, ground_, scenery, random_);
    } else {
      add_roadside(scenery);
    }
    if (scenery.moving_cars > 0.0) add_traffic(scenery.moving_cars);
    return std::move(world_);
  }

 private:
  using AddAt = void (WorldBuilder::*)(double station_m, bool left);

  void add_roadside(const Scenery& scenery) {
    along_both_sides(scenery.buildings, &WorldBuilder::add_building_at);
    along_both_sides(scenery.boundaries, &WorldBuilder::add_boundary_at);
    along_both_sides(scenery.poles, &WorldBuilder::add_lamp_at);
    along_both_sides(scenery.signs, &WorldBuilder::add_sign_at);
    along_both_sides(scenery.trees, &WorldBuilder::add_tree_at);
    if (route_.road.parking_width_m > 1.5) {
      along_both_sides(scenery.parked_cars, &WorldBuilder::park_car_at);
    }
  }

  void along_both_sides(double per_100m, AddAt add) {
    if (per_100m <= 0.0) return;
    const double spacing_m = 2.0 * 100.0 / per_100m;
    const Path& path = ground_.path();
    for (const bool left : {false, true}) {
      for (double s = path.first_station_m(); s < path.last_station_m(); s += spacing_m) {
        const double station_m = s + random_.uniform(0.0, 0.7 * spacing_m);
        if (!ground_.in_side_street(station_m, left, 1.5)) (this->*add)(station_m, left);
      }
    }
  }

  /// `away_m` from the middle of the road.
  RoadPosition beside(double station_m, bool left, double away_m) const {
    return {station_m, route_.road.centre_offset_m() + (left ? away_m : -away_m)};
  }
  double pavement_edge_m() const { return route_.road.half_width_m() + route_.road.pavement_width_m; }

  /// On the ground, x along the road as the vehicle drives, turned around on its left side: y points away.
  Place place_facing_road(const RoadPosition& position, bool left) const {
    const double heading_rad = ground_.path().at(position.station_m).heading_rad;
    return make_place(ground_.point_m(position), left ? heading_rad : heading_rad + std::numbers::pi);
  }

  bool reaches_the_road(const Footprint& footprint) const {
    for (double u = -1.0; u <= 1.0; u += 0.25) {
      for (const double v : {-1.0, 1.0}) {
        if (ground_.distance_to_road_m(footprint.at(u, v)) < pavement_edge_m() + 0.3) return true;
      }
    }
    return false;
  }

  void add_building_at(double station_m, bool left) {
    const double spacing_m = 200.0 / route_.scenery.buildings;
    const BuildingSize size{
        .width_m = random_.uniform(0.45, 0.95) * std::min(spacing_m, 34.0),
        .depth_m = random_.uniform(8.0, 14.0),
        .height_m = std::max(3.2, route_.scenery.building_height_m * random_.uniform(0.55, 1.45))};
    const double setback_m = 0.4 + route_.scenery.building_setback_m * random_.uniform(0.2, 1.8);
    const RoadPosition front = beside(station_m, left, pavement_edge_m() + setback_m);
    Place place = place_facing_road(front, left) *
                  make_place(Eigen::Vector3d::Zero(), random_.uniform(-0.04, 0.04)) *
                  make_place({-0.5 * size.width_m, 0.0, 0.0}, 0.0);
    const Eigen::Vector3d centre_m = place * Eigen::Vector3d(0.5 * size.width_m, 0.5 * size.depth_m, 0.0);
    const Footprint footprint{.centre_m = centre_m.head<2>(),
                              .axis = place.linear().col(0).head<2>(),
                              .half_size_m = {0.5 * size.width_m + 0.6, 0.5 * size.depth_m + 0.6}};
    if (ground_.in_side_street(station_m, left, 0.5 * size.width_m + 1.0) || reaches_the_road(footprint) ||
        !layout_.claim(footprint)) {
      return;
    }
    double low_m = place.translation().z();
    double high_m = low_m;
    for (const double u : {-1.0, 0.0, 1.0}) {
      for (const double v : {-1.0, 0.0, 1.0}) {
        const double height_m = ground_.height_m(footprint.at(u, v));
        low_m = std::min(low_m, height_m);
        high_m = std::max(high_m, height_m);
      }
    }
    place.translation().z() = low_m;
    add_building(world_.surveyed, place, size, high_m - low_m, random_);
  }

  /// Hedges, fences and walls follow the ground in short pieces.
  void add_boundary_at(double station_m, bool left) {
    constexpr double kPiece_m = 2.5;
    const int pieces = static_cast<int>(random_.uniform(2.0, 7.0));
    const double away_m = pavement_edge_m() + random_.uniform(0.4, 1.2);
    const double height_m = random_.uniform(0.7, 1.6);
    const double kind = random_.uniform(0.0, 3.0);
    for (int piece = 0; piece < pieces; ++piece) {
      const double s = station_m + kPiece_m * piece;
      if (ground_.in_side_street(s, left, kPiece_m + 0.5)) continue;
      const Eigen::Vector3d start_m = ground_.point_m(beside(s, left, away_m));
      const Eigen::Vector3d end_m = ground_.point_m(beside(s + kPiece_m, left, away_m));
      const Eigen::Vector3d along_m = end_m - start_m;
      const double length_m = along_m.head<2>().norm();
      const Footprint footprint{.centre_m = 0.5 * (start_m + end_m).head<2>(),
                                .axis = along_m.head<2>() / length_m,
                                .half_size_m = {0.48 * length_m, 0.2}};
      if (!layout_.claim(footprint)) continue;
      const Place place = make_place(start_m, std::atan2(along_m.y(), along_m.x())) *
                          Eigen::AngleAxisd(-std::atan2(along_m.z(), length_m), Eigen::Vector3d::UnitY());
      if (kind < 1.0) {
        add_hedge(world_.surveyed, place, length_m, height_m, random_);
      } else if (kind < 2.0) {
        add_fence(world_.surveyed, place, length_m);
      } else {
        add_garden_wall(world_.surveyed, place, length_m, 0.8 * height_m);
      }
    }
  }

  /// Takes a small square around a place on the pavement or beyond it.
  bool claim_spot(const RoadPosition& position, double size_m) {
    const Eigen::Vector2d xy_m = ground_.point_m(position).head<2>();
    if (ground_.distance_to_road_m(xy_m) < route_.road.half_width_m() + 0.25) return false;
    return layout_.claim({.centre_m = xy_m,
                          .axis = ground_.path().at(position.station_m).forward(),
                          .half_size_m = Eigen::Vector2d::Constant(0.5 * size_m)});
  }

  void add_lamp_at(double station_m, bool left) {
    const RoadPosition position = beside(station_m, left, route_.road.half_width_m() + 0.45);
    if (!claim_spot(position, 0.4)) return;
    // Its arm reaches over the road.
    add_lamp(world_.surveyed, place_facing_road(position, !left), random_);
  }

  void add_sign_at(double station_m, bool left) {
    const RoadPosition position = beside(station_m, left, route_.road.half_width_m() + 0.6);
    if (!claim_spot(position, 0.4)) return;
    add_sign(world_.surveyed, place_facing_road(position, !left), random_);
  }

  void add_tree_at(double station_m, bool left) {
    const bool by_the_road = random_.chance(0.5);
    const double away_m =
        by_the_road ? pavement_edge_m() - 0.5 : pavement_edge_m() + random_.uniform(1.5, 22.0);
    const RoadPosition position = beside(station_m, left, away_m);
    if (!claim_spot(position, by_the_road ? 0.8 : 2.5)) return;
    add_tree(world_.surveyed, place_facing_road(position, left), random_);
  }

  void park_car_at(double station_m, bool left) {
    constexpr double kLength_m = kCarFront_m - kCarRear_m;
    const double away_m = route_.road.half_width_m() - 0.5 * route_.road.parking_width_m;
    const RoadPosition position = beside(station_m, left, away_m + random_.uniform(-0.1, 0.1));
    // Most stand in the direction of traffic, some against it.
    const bool turned = left != random_.chance(0.15);
    const double middle_m = 0.5 * (kCarFront_m + kCarRear_m) * (turned ? -1.0 : 1.0);
    if (ground_.in_side_street(station_m + middle_m, left, 0.5 * kLength_m)) return;
    const double turn_rad = (turned ? std::numbers::pi : 0.0) + random_.uniform(-0.03, 0.03);
    const Place place = ground_.vehicle_place(position, turn_rad);
    const Eigen::Vector3d centre_m = place * Eigen::Vector3d(0.5 * (kCarFront_m + kCarRear_m), 0.0, 0.0);
    const Footprint footprint{.centre_m = centre_m.head<2>(),
                              .axis = place.linear().col(0).head<2>().normalized(),
                              .half_size_m = {0.5 * kLength_m + 0.3, 0.9}};
    if (!layout_.claim(footprint)) return;
    add_mesh(world_.parked, place, car_models()[random_model()]);
  }

  std::size_t random_model() {
    return static_cast<std::size_t>(random_.uniform(0.0, static_cast<double>(kCarModels)));
  }

  /// One car ahead in the vehicle's lane, one beside it where there is a second lane, and those that come
  /// towards it, spread over as much road as they and the vehicle will drive.
  void add_traffic(double per_100m) {
    const RoadProfile& road = route_.road;
    world_.traffic.push_back({.station_m = 18.0, .follows_vehicle = 1.03, .model = random_model()});
    if (road.lanes >= 4) {
      world_.traffic.push_back({.station_m = -30.0,
                                .offset_m = road.lane_width_m,
                                .follows_vehicle = 1.15,
                                .model = random_model()});
    }
    if (road.lanes < 2) return;
    const double spacing_m = 100.0 / per_100m;
    const double end_m = 2.5 * ground_.path().length_m() + 100.0;
    for (double s = 25.0; s < end_m; s += spacing_m * random_.uniform(1.0, 3.0)) {
      const double lane = std::floor(random_.uniform(0.0, 0.5 * static_cast<double>(road.lanes)));
      // One speed a lane, so that nobody drives through the car ahead.
      world_.traffic.push_back(
          {.station_m = s,
           .offset_m = road.lane_width_m * (lane + 0.5 * static_cast<double>(road.lanes)),
           .speed_mps = -(1.0 - 0.15 * lane) * route_.segments.front().speed_mps,
           .model = random_model()});
    }
  }

  const Route& route_;
  const Ground& ground_;
  Random random_;
  Layout layout_;
  World world_;
};

}  // namespace

World build_world(const Route& route, const Ground& ground, std::uint64_t seed) {
  return WorldBuilder(route, ground, seed).build();
}

std::vector<SideStreet> plan_side_streets(const Route& route, const Path& path, std::uint64_t seed) {
  std::vector<SideStreet> streets;
  if (route.city || route.scenery.side_streets <= 0.0) return streets;
  Random random(mix_bits(seed), RandomStream::world);
  const double spacing_m = 100.0 / route.scenery.side_streets;
  for (double s = path.first_station_m(); s < path.last_station_m(); s += spacing_m) {
    streets.push_back({.station_m = s + random.uniform(0.2, 0.8) * spacing_m,
                       .width_m = random.uniform(6.0, 10.0),
                       .left = random.chance(0.5)});
  }
  return streets;
}

}  // namespace landfix::tools::simulator
