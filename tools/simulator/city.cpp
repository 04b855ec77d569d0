#include "tools/simulator/city.hpp"

#include <algorithm>
#include <numbers>

#include "tools/simulator/building.hpp"
#include "tools/simulator/car_model.hpp"
#include "tools/simulator/footprint.hpp"
#include "tools/simulator/street_furniture.hpp"
#include "tools/simulator/vegetation.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr double kDeepest_m = 12.0;   // house
constexpr double kNarrowest_m = 9.0;  // house
constexpr double kCrossing_m = 5.0;   // nothing stands or parks so near the rounding of the kerb

/// One edge of a block: x along its kerb, y into the block.
struct BlockSide {
  Place place;
  double length_m;
};

class CityBuilder {
 public:
  CityBuilder(Mesh& surveyed, Mesh& parked, const Ground& ground, const Scenery& scenery, Random& random)
      : surveyed_(surveyed),
        parked_(parked),
        ground_(ground),
        streets_(*ground.streets()),
        scenery_(scenery),
        random_(random),
        front_m_(ground.road().pavement_width_m + 0.3) {}

  void build() {
    for (std::size_t block = 0; block < streets_.blocks(); ++block) {
      layout_ = {};
      for (int side = 0; side < 4; ++side) add_side(side_of(block, side));
    }
  }

 private:
  using AddAt = void (CityBuilder::*)(const BlockSide& side, double x_m);

  BlockSide side_of(std::size_t block, int side) const {
    const Eigen::Vector2d middle_m = streets_.middle_m(block);
    const Eigen::Vector2d half_m =
        side % 2 == 0 ? streets_.half_block_m : Eigen::Vector2d(streets_.half_block_m.reverse());
    return {.place = make_place({middle_m.x(), middle_m.y(), 0.0}, side * std::numbers::pi / 2.0) *
                     make_place({-half_m.x(), -half_m.y(), 0.0}, 0.0),
            .length_m = 2.0 * half_m.x()};
  }

  void add_side(const BlockSide& side) {
    if (scenery_.buildings > 0.0) add_houses(side);
    along(side, scenery_.poles, &CityBuilder::add_lamp_at);
    along(side, scenery_.signs, &CityBuilder::add_sign_at);
    along(side, scenery_.trees, &CityBuilder::add_tree_at);
    if (ground_.road().parking_width_m > 1.5) along(side, scenery_.parked_cars, &CityBuilder::park_car_at);
  }

  /// From beside the first house of the side before to the corner: the four rows close around the yard.
  void add_houses(const BlockSide& side) {
    const double mean_width_m = 200.0 / scenery_.buildings;
    const double end_m = side.length_m - front_m_;
    for (double x_m = front_m_ + kDeepest_m + 1.0; end_m - x_m >= kNarrowest_m;) {
      double width_m = std::max(kNarrowest_m, mean_width_m * random_.uniform(0.7, 1.3));
      if (end_m - x_m - width_m < kNarrowest_m) width_m = end_m - x_m;
      const BuildingSize size{
          .width_m = width_m,
          .depth_m = random_.uniform(9.0, kDeepest_m - 0.6),
          .height_m = std::max(3.2, scenery_.building_height_m * random_.uniform(0.55, 1.45))};
      const double setback_m = random_.uniform(0.0, 0.6);
      add_building(surveyed_, on_ground(side, x_m, front_m_ + setback_m), size, 0.0, random_);
      x_m += width_m;
      if (!random_.chance(0.3)) continue;
      const double gap_m = random_.uniform(3.0, 9.0);
      if (x_m + gap_m < end_m) {
        add_garden_wall(surveyed_, on_ground(side, x_m, front_m_ + 0.5), gap_m, random_.uniform(1.6, 2.4));
      }
      x_m += gap_m;
    }
  }

  void along(const BlockSide& side, double per_100m, AddAt add) {
    if (per_100m <= 0.0) return;
    const double spacing_m = 2.0 * 100.0 / per_100m;
    const double corner_m = streets_.corner_radius_m + kCrossing_m;
    for (double x_m = corner_m; x_m < side.length_m - corner_m; x_m += spacing_m) {
      const double place_m = x_m + random_.uniform(0.0, 0.7 * spacing_m);
      if (place_m < side.length_m - corner_m) (this->*add)(side, place_m);
    }
  }

  Place on_ground(const BlockSide& side, double x_m, double y_m, double turn_rad = 0.0) const {
    Place place = side.place * make_place({x_m, y_m, 0.0}, turn_rad);
    place.translation().z() = ground_.height_m(Eigen::Vector2d(place.translation().head<2>()));
    return place;
  }

  bool claim(const Place& place, double middle_m, const Eigen::Vector2d& half_size_m) {
    const Eigen::Vector3d centre_m = place * Eigen::Vector3d(middle_m, 0.0, 0.0);
    return layout_.claim({.centre_m = centre_m.head<2>(),
                          .axis = place.linear().col(0).head<2>(),
                          .half_size_m = half_size_m});
  }
  bool claim_spot(const Place& place, double size_m) {
    return claim(place, 0.0, Eigen::Vector2d::Constant(0.5 * size_m));
  }

  // Turned around: their arms and faces are the street's.
  void add_lamp_at(const BlockSide& side, double x_m) {
    const Place place = on_ground(side, x_m, 0.45, std::numbers::pi);
    if (claim_spot(place, 0.4)) add_lamp(surveyed_, place, random_);
  }

  void add_sign_at(const BlockSide& side, double x_m) {
    const Place place = on_ground(side, x_m, 0.6, std::numbers::pi);
    if (claim_spot(place, 0.4)) add_sign(surveyed_, place, random_);
  }

  void add_tree_at(const BlockSide& side, double x_m) {
    const double yard_m = front_m_ + kDeepest_m + 4.0;
    const double y_m = random_.chance(0.6) ? 0.9 : yard_m + random_.uniform(0.0, 8.0);
    const Place place = on_ground(side, x_m, y_m);
    if (claim_spot(place, 0.8)) add_tree(surveyed_, place, random_);
  }

  void park_car_at(const BlockSide& side, double x_m) {
    constexpr double kMiddle_m = 0.5 * (kCarFront_m + kCarRear_m);
    const double turn_rad = (random_.chance(0.15) ? 0.0 : std::numbers::pi) + random_.uniform(-0.03, 0.03);
    const double y_m = -0.5 * ground_.road().parking_width_m + random_.uniform(-0.1, 0.1);
    const Place place = on_ground(side, x_m, y_m, turn_rad);
    const auto model = static_cast<std::size_t>(random_.uniform(0.0, static_cast<double>(kCarModels)));
    if (!claim(place, kMiddle_m, {0.5 * (kCarFront_m - kCarRear_m) + 0.3, 0.9})) return;
    add_mesh(parked_, place, car_models()[model]);
  }

  Mesh& surveyed_;
  Mesh& parked_;
  const Ground& ground_;
  const StreetGrid& streets_;
  const Scenery& scenery_;
  Random& random_;
  Layout layout_;   ///< of one block
  double front_m_;  ///< from the kerb to where houses may begin
};

}  // namespace

void add_city(Mesh& surveyed, Mesh& parked, const Ground& ground, const Scenery& scenery, Random& random) {
  CityBuilder(surveyed, parked, ground, scenery, random).build();
}

}  // namespace landfix::tools::simulator
