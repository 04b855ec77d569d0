#include "tools/simulator/ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "ndt/pose.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/unevenness.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr double kPavementFall = 0.75;  // of the road's
constexpr double kLoweredKerb_m = 0.02;
constexpr double kVergeBlend_m = 4.5;    // from the pavement's level to the land's
constexpr double kVergeOverlap_m = 1.5;  // where road sheet and land sheet lie on each other
constexpr double kCoarseSpacing_m = 2.0;
constexpr double kWheelbase_m = 2.7;
constexpr double kTrack_m = 1.56;

// A road is even to millimetres.
constexpr std::array kRoadWaves{Wave{0.003, 13.0, 0.2}, Wave{0.002, 7.3, -0.5}, Wave{0.0015, 5.1, 1.1}};

double smooth_step(double u) {
  const double v = std::clamp(u, 0.0, 1.0);
  return v * v * (3.0 - 2.0 * v);
}

}  // namespace

Ground::Ground(const Path& path, const Route& route, std::vector<SideStreet> side_streets, std::uint64_t seed)
    : path_(path),
      road_(route.road),
      land_profile_(route.land),
      side_streets_(std::move(side_streets)),
      phase_rad_(2.0 * std::numbers::pi * to_unit(mix_bits(seed))) {
  for (double s = path.first_station_m(); s <= path.last_station_m(); s += kCoarseSpacing_m) {
    coarse_.push_back(path.at(s));
  }
  if (route.city) {
    streets_.emplace(*route.city, road_);
  } else {
    survey_land();
  }
}

double Ground::corridor_half_width_m() const noexcept {
  return road_.half_width_m() + road_.pavement_width_m + kVergeBlend_m + kVergeOverlap_m;
}

bool Ground::in_side_street(double station_m, bool left, double margin_m) const noexcept {
  return std::ranges::any_of(side_streets_, [&](const SideStreet& street) {
    return street.left == left && std::abs(street.station_m - station_m) < 0.5 * street.width_m + margin_m;
  });
}

double Ground::kerb_m(double station_m, bool left) const noexcept {
  constexpr double kRamp_m = 1.5;
  const double lowered_m = std::min(kLoweredKerb_m, road_.kerb_m);
  double kerb_m = road_.kerb_m;
  for (const SideStreet& street : side_streets_) {
    if (street.left != left) continue;
    const double beyond_m = std::abs(street.station_m - station_m) - 0.5 * street.width_m;
    kerb_m = std::min(kerb_m, lowered_m + (road_.kerb_m - lowered_m) * smooth_step(beyond_m / kRamp_m));
  }
  return kerb_m;
}

/// Height over the crown of the road, `across_m` left of its middle.
double Ground::profile_m(double station_m, double across_m) const noexcept {
  const double half_m = road_.half_width_m();
  const double away_m = std::abs(across_m);
  if (away_m <= half_m) return -road_.cross_fall * away_m;
  const double on_pavement_m = std::min(away_m - half_m, road_.pavement_width_m);
  return -road_.cross_fall * half_m + kerb_m(station_m, across_m > 0.0) +
         kPavementFall * road_.cross_fall * on_pavement_m;
}

double Ground::road_height_m(const PathPoint& point, double station_m, double across_m) const noexcept {
  const double under_vehicle_m = -road_.cross_fall * std::abs(road_.centre_offset_m());
  return point.position_m.z() + profile_m(station_m, across_m) - under_vehicle_m +
         unevenness_m(kRoadWaves, station_m, across_m, phase_rad_);
}

/// A city is level, and each of its streets has the road's profile.
double Ground::street_height_m(const Eigen::Vector2d& xy_m) const noexcept {
  return profile_m(0.0, streets_->distance_to_street_m(xy_m)) +
         road_.cross_fall * std::abs(road_.centre_offset_m()) +
         unevenness_m(kRoadWaves, xy_m.x(), xy_m.y(), phase_rad_);
}

double Ground::height_m(const RoadPosition& place) const noexcept {
  const PathPoint point = path_.at(place.station_m);
  if (streets_) return street_height_m(point.position_m.head<2>() + place.offset_m * point.left());
  const double across_m = place.offset_m - road_.centre_offset_m();
  const double verge_m = std::abs(across_m) - road_.half_width_m() - road_.pavement_width_m;
  const double road_m = road_height_m(point, place.station_m, across_m);
  if (verge_m <= 0.0) return road_m;
  const Eigen::Vector2d xy_m = point.position_m.head<2>() + place.offset_m * point.left();
  return std::lerp(road_m, land_height_m(xy_m), smooth_step(verge_m / kVergeBlend_m));
}

double Ground::height_m(const Eigen::Vector2d& xy_m) const noexcept {
  if (streets_) return street_height_m(xy_m);
  const RoadPosition place = project(xy_m);
  const double across_m = std::abs(place.offset_m - road_.centre_offset_m());
  return across_m < corridor_half_width_m() ? height_m(place) : land_height_m(xy_m);
}

Eigen::Vector3d Ground::point_m(const RoadPosition& place) const noexcept {
  const PathPoint point = path_.at(place.station_m);
  const Eigen::Vector2d xy_m = point.position_m.head<2>() + place.offset_m * point.left();
  return {xy_m.x(), xy_m.y(), height_m(place)};
}

RoadPosition Ground::project(const Eigen::Vector2d& xy_m) const noexcept {
  const auto distance_m = [&](std::size_t i) { return (coarse_[i].position_m.head<2>() - xy_m).norm(); };
  // A rough search first: places whose distance cannot fall below it are passed over.
  constexpr std::size_t kStride = 16;
  double bound_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < coarse_.size(); i += kStride) bound_m = std::min(bound_m, distance_m(i));
  std::size_t nearest = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < coarse_.size();) {
    const double here_m = distance_m(i);
    if (here_m < least_m) {
      least_m = here_m;
      nearest = i;
    }
    i += static_cast<std::size_t>(std::max(1.0, (here_m - bound_m) / kCoarseSpacing_m));
  }
  double station_m = path_.first_station_m() + kCoarseSpacing_m * static_cast<double>(nearest);
  for (int step = 0; step < 3; ++step) {  // Newton, curvature left out: it converges from 1 m
    const PathPoint point = path_.at(station_m);
    station_m += (xy_m - point.position_m.head<2>()).dot(point.forward());
    station_m = std::clamp(station_m, path_.first_station_m(), path_.last_station_m());
  }
  const PathPoint point = path_.at(station_m);
  const Eigen::Vector2d away_m = xy_m - point.position_m.head<2>();
  return {.station_m = station_m, .offset_m = std::copysign(away_m.norm(), away_m.dot(point.left()))};
}

double Ground::distance_to_road_m(const Eigen::Vector2d& xy_m) const noexcept {
  if (streets_) return streets_->distance_to_street_m(xy_m);
  return std::abs(project(xy_m).offset_m - road_.centre_offset_m());
}

double Ground::distance_to_drive_m(const Eigen::Vector2d& xy_m, double margin_m) const noexcept {
  if (streets_) return streets_->distance_to_street_m(xy_m);
  const RoadPosition place = project(xy_m);
  if (place.station_m < -margin_m || place.station_m > path_.length_m() + margin_m) {
    return std::numeric_limits<double>::infinity();
  }
  return std::abs(place.offset_m - road_.centre_offset_m());
}

Place Ground::vehicle_place(const RoadPosition& place, double turn_rad) const noexcept {
  const double side_m = 0.5 * kTrack_m;
  const double left_m = height_m(RoadPosition{place.station_m, place.offset_m + side_m});
  const double right_m = height_m(RoadPosition{place.station_m, place.offset_m - side_m});
  const double rear_m = 0.5 * (left_m + right_m);
  const double ahead_m = kWheelbase_m * std::cos(turn_rad);
  const double aside_m = kWheelbase_m * std::sin(turn_rad);
  const double front_m = height_m(RoadPosition{place.station_m + ahead_m, place.offset_m + aside_m});
  // Left and right are the road's; a vehicle that faces the other way has them swapped.
  const double left_rise_m = (left_m - right_m) * std::cos(turn_rad);
  const PathPoint point = path_.at(place.station_m);
  const Eigen::Vector2d xy_m = point.position_m.head<2>() + place.offset_m * point.left();
  return ndt::make_pose({xy_m.x(), xy_m.y(), rear_m},
                        {.roll_rad = std::asin(left_rise_m / kTrack_m),
                         .pitch_rad = -std::asin((front_m - rear_m) / kWheelbase_m),
                         .yaw_rad = point.heading_rad + turn_rad});
}

}  // namespace landfix::tools::simulator
