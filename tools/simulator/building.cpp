#include "tools/simulator/building.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace landfix::tools::simulator {
namespace {

constexpr double kFloor_m = 3.0;
constexpr double kFoundation_m = 0.4;

/// What the walls of one house have in common.
struct Style {
  Surface wall;
  double bay_m;
  double window_width_m;
  double window_height_m;
  double recess_m;
  double ledge_m;    ///< how far a ledge juts out; 0: there is none
  double balconies;  ///< share of the bays of the street front
};

Style choose_style(Random& random) {
  return {.wall = random.chance(0.6) ? Surface::plaster : Surface::brick,
          .bay_m = random.uniform(2.4, 3.8),
          .window_width_m = random.uniform(0.9, 1.5),
          .window_height_m = random.uniform(1.2, 1.7),
          .recess_m = random.uniform(0.10, 0.28),
          .ledge_m = random.chance(0.6) ? random.uniform(0.08, 0.2) : 0.0,
          .balconies = random.chance(0.4) ? random.uniform(0.2, 0.6) : 0.0};
}

/// An opening in one bay of a wall: x along the wall, z up, y into the house.
struct Opening {
  double left_m;
  double right_m;
  double low_m;
  double high_m;
  double recess_m;
  Surface surface;
};

void add_bay(Mesh& mesh, const Place& wall, double left_m, double right_m, double low_m, double high_m,
             const Opening& hole, Surface surface) {
  const auto face = [&](double x0, double x1, double z0, double z1) {
    add_quad(mesh, wall, {{{x0, 0, z0}, {x1, 0, z0}, {x1, 0, z1}, {x0, 0, z1}}}, surface);
  };
  face(left_m, right_m, low_m, hole.low_m);
  face(left_m, right_m, hole.high_m, high_m);
  face(left_m, hole.left_m, hole.low_m, hole.high_m);
  face(hole.right_m, right_m, hole.low_m, hole.high_m);
  const std::array<Eigen::Vector2d, 4> rim = {{{hole.left_m, hole.low_m},
                                               {hole.right_m, hole.low_m},
                                               {hole.right_m, hole.high_m},
                                               {hole.left_m, hole.high_m}}};
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Eigen::Vector2d& a = rim[i];
    const Eigen::Vector2d& b = rim[(i + 1) % rim.size()];
    add_quad(mesh, wall,
             {{{a.x(), 0, a.y()},
               {b.x(), 0, b.y()},
               {b.x(), hole.recess_m, b.y()},
               {a.x(), hole.recess_m, a.y()}}},
             surface);
  }
  add_quad(mesh, wall,
           {{{rim[0].x(), hole.recess_m, rim[0].y()},
             {rim[1].x(), hole.recess_m, rim[1].y()},
             {rim[2].x(), hole.recess_m, rim[2].y()},
             {rim[3].x(), hole.recess_m, rim[3].y()}}},
           hole.surface);
}

void add_balcony(Mesh& mesh, const Place& wall, double centre_m, double floor_m) {
  constexpr double kHalfWidth_m = 1.1;
  constexpr double kDepth_m = 1.1;
  add_box(mesh, wall, {centre_m - kHalfWidth_m, -kDepth_m, floor_m - 0.15},
          {centre_m + kHalfWidth_m, 0.0, floor_m}, Surface::concrete);
  add_box(mesh, wall, {centre_m - kHalfWidth_m, -kDepth_m, floor_m},
          {centre_m + kHalfWidth_m, 0.06 - kDepth_m, floor_m + 1.0}, Surface::metal);
}

/// A wall of `width_m`, its bays above the plinth filled with windows; a front has a door and balconies.
void add_wall(Mesh& mesh, const Place& wall, double width_m, double height_m, double plinth_m,
              const Style& style, bool front, Random& random) {
  add_quad(mesh, wall,
           {{{0, 0, -kFoundation_m}, {width_m, 0, -kFoundation_m}, {width_m, 0, plinth_m}, {0, 0, plinth_m}}},
           Surface::concrete);
  const int bays = std::max(1, static_cast<int>(width_m / style.bay_m));
  const int floors = std::max(1, static_cast<int>((height_m - plinth_m) / kFloor_m));
  const double bay_m = width_m / bays;
  const double floor_m = (height_m - plinth_m) / floors;
  const int door_bay = front ? static_cast<int>(random.uniform(0.0, bays)) : -1;
  for (int floor = 0; floor < floors; ++floor) {
    const double low_m = plinth_m + floor * floor_m;
    for (int bay = 0; bay < bays; ++bay) {
      const double centre_m = (bay + 0.5) * bay_m;
      const double half_m = 0.5 * std::min(style.window_width_m, bay_m - 0.4);
      const bool door = floor == 0 && bay == door_bay;
      const Opening hole{
          .left_m = centre_m - half_m,
          .right_m = centre_m + half_m,
          .low_m = low_m + (door ? 0.05 : 0.9),
          .high_m = low_m + (door ? 2.15 : std::min(0.9 + style.window_height_m, floor_m - 0.2)),
          .recess_m = door ? 0.45 : style.recess_m,
          .surface = door ? Surface::wood : Surface::glass};
      add_bay(mesh, wall, bay * bay_m, (bay + 1) * bay_m, low_m, low_m + floor_m, hole, style.wall);
      if (front && floor > 0 && random.chance(style.balconies)) add_balcony(mesh, wall, centre_m, low_m);
    }
    if (style.ledge_m > 0.0) {
      add_box(mesh, wall, {0.0, -style.ledge_m, low_m + floor_m - 0.2}, {width_m, 0.0, low_m + floor_m},
              Surface::concrete);
    }
  }
}

/// A ridge along the street over the width of the house, or a flat roof with a parapet.
void add_roof(Mesh& mesh, const Place& place, const BuildingSize& size, const Style& style, bool pitched) {
  const double w = size.width_m;
  const double d = size.depth_m;
  const double h = size.height_m;
  if (!pitched) {
    add_quad(mesh, place, {{{0, 0, h}, {w, 0, h}, {w, d, h}, {0, d, h}}}, Surface::concrete);
    add_box(mesh, place, {0.0, 0.0, h}, {w, 0.25, h + 0.6}, style.wall);
    add_box(mesh, place, {0.0, d - 0.25, h}, {w, d, h + 0.6}, style.wall);
    return;
  }
  constexpr double kEaves_m = 0.4;
  const double ridge_m = h + 0.35 * d;
  const double eaves_m = h - kEaves_m * 0.7;
  add_quad(mesh, place,
           {{{0, -kEaves_m, eaves_m}, {w, -kEaves_m, eaves_m}, {w, d / 2, ridge_m}, {0, d / 2, ridge_m}}},
           Surface::brick);
  add_quad(
      mesh, place,
      {{{0, d + kEaves_m, eaves_m}, {w, d + kEaves_m, eaves_m}, {w, d / 2, ridge_m}, {0, d / 2, ridge_m}}},
      Surface::brick);
  for (const double x : {0.0, w}) {
    add_triangle(mesh, place, {{{x, 0, h}, {x, d, h}, {x, d / 2, ridge_m}}}, style.wall);
  }
}

}  // namespace

void add_building(Mesh& mesh, const Place& place, const BuildingSize& size, double plinth_m, Random& random) {
  const Style style = choose_style(random);
  const auto wall = [&place](double x_m, double y_m, double turns) {
    return place * make_place({x_m, y_m, 0.0}, turns * std::numbers::pi / 2.0);
  };
  const double w = size.width_m;
  const double d = size.depth_m;
  const auto add = [&](const Place& at, double width_m, bool front) {
    add_wall(mesh, at, width_m, size.height_m, plinth_m + 0.3, style, front, random);
  };
  add(wall(0, 0, 0), w, true);
  add(wall(w, 0, 1), d, false);
  add(wall(w, d, 2), w, false);
  add(wall(0, d, 3), d, false);
  add_roof(mesh, place, size, style, size.height_m < 11.0 && random.chance(0.7));
}

}  // namespace landfix::tools::simulator
