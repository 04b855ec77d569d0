#include "tools/simulator/vehicle_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/speed_profile.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr double kKnotPeriod_s = 0.005;

/// Nobody keeps to the middle of the lane: where the vehicle is beside it, and its derivative by the station.
struct Wander {
  double offset_m;
  double slope;
};

Wander wander_at(double station_m) {
  constexpr double kAmplitude_m = 0.12;
  constexpr double kLength_m = 55.0;
  const double phase_rad = 2.0 * std::numbers::pi * station_m / kLength_m;
  return {.offset_m = kAmplitude_m * std::sin(phase_rad),
          .slope = kAmplitude_m * 2.0 * std::numbers::pi / kLength_m * std::cos(phase_rad)};
}

/// How the body leans on its springs, on top of the ground's tilt.
struct Lean {
  double roll_rad;
  double pitch_rad;
};

Lean suspension(double time_s, double speed_mps, double acceleration_mps2, double curvature_1pm) {
  const auto wave = [time_s](double frequency_hz, double phase_rad) {
    return std::sin(2.0 * std::numbers::pi * frequency_hz * time_s + phase_rad);
  };
  // Springs swing only while the vehicle rolls.
  const double liveliness = speed_mps / (speed_mps + 4.0);
  const double outwards = speed_mps * speed_mps * curvature_1pm;
  return {.roll_rad = ndt::kRadians_per_deg *
                      (0.15 * outwards + liveliness * (0.16 * wave(1.1, 0.3) + 0.08 * wave(1.7, 1.9))),
          .pitch_rad =
              ndt::kRadians_per_deg *
              (-0.15 * acceleration_mps2 + liveliness * (0.14 * wave(1.3, 1.1) + 0.07 * wave(2.1, 0.2)))};
}

}  // namespace

VehicleMotion::VehicleMotion(const Route& route, const Ground& ground) {
  const std::vector<double> stations_m = drive_stations(route, ground.path(), kKnotPeriod_s);
  knots_.reserve(stations_m.size());
  for (std::size_t i = 0; i < stations_m.size(); ++i) {
    const double before_m = stations_m[i == 0 ? 0 : i - 1];
    const double station_m = stations_m[i];
    const double after_m = stations_m[std::min(i + 1, stations_m.size() - 1)];
    const double speed_mps = (after_m - before_m) / (2.0 * kKnotPeriod_s);
    const double acceleration_mps2 = (after_m - 2.0 * station_m + before_m) / (kKnotPeriod_s * kKnotPeriod_s);

    const Wander wander = wander_at(station_m);
    const double curvature_1pm = ground.path().at(station_m).curvature_1pm;
    const double turn_rad = std::atan2(wander.slope, 1.0 - curvature_1pm * wander.offset_m);
    const ndt::Pose resting = ground.vehicle_place({station_m, wander.offset_m}, turn_rad);
    const ndt::RollPitchYaw angles = ndt::to_roll_pitch_yaw(resting.linear());
    const Lean lean =
        suspension(static_cast<double>(i) * kKnotPeriod_s, speed_mps, acceleration_mps2, curvature_1pm);
    Knot& knot = knots_.emplace_back();
    knot << resting.translation(), angles.roll_rad + lean.roll_rad, angles.pitch_rad + lean.pitch_rad,
        ground.path().at(station_m).heading_rad + turn_rad, station_m;
  }
}

double VehicleMotion::duration_s() const noexcept {
  return static_cast<double>(knots_.size() - 1) * kKnotPeriod_s;
}

VehicleMotion::Knot VehicleMotion::value_at(double time_s) const noexcept {
  const double place = std::clamp(time_s / kKnotPeriod_s, 0.0, static_cast<double>(knots_.size() - 1));
  const std::size_t i = std::min(static_cast<std::size_t>(place), knots_.size() - 2);
  const double u = place - static_cast<double>(i);
  // Catmull and Rom's spline.
  const Knot& p0 = knots_[i == 0 ? 0 : i - 1];
  const Knot& p1 = knots_[i];
  const Knot& p2 = knots_[i + 1];
  const Knot& p3 = knots_[std::min(i + 2, knots_.size() - 1)];
  return p1 +
         0.5 * u * (p2 - p0 + u * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3 + u * (3.0 * (p1 - p2) + p3 - p0)));
}

ndt::Pose VehicleMotion::pose_at(double time_s) const noexcept {
  const Knot knot = value_at(time_s);
  return ndt::make_pose(knot.head<3>(), {.roll_rad = knot[3], .pitch_rad = knot[4], .yaw_rad = knot[5]});
}

double VehicleMotion::station_at(double time_s) const noexcept { return value_at(time_s)[6]; }

double VehicleMotion::speed_at(double time_s) const noexcept {
  return (station_at(time_s + kKnotPeriod_s) - station_at(time_s - kKnotPeriod_s)) / (2.0 * kKnotPeriod_s);
}

}  // namespace landfix::tools::simulator
