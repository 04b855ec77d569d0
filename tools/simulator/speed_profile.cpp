#include "tools/simulator/speed_profile.hpp"

#include <algorithm>
#include <cmath>

namespace landfix::tools::simulator {
namespace {

constexpr double kAcceleration_mps2 = 1.5;
constexpr double kLateralAcceleration_mps2 = 2.0;
constexpr double kStep_m = 0.25;
constexpr double kStanding_s = 1.0;
constexpr double kJerkTime_s = 0.8;  // over which a change of acceleration is spread

/// Squares of the speeds every `kStep_m`: constant acceleration makes them linear in the distance.
std::vector<double> squared_speeds(const Route& route, const Path& path) {
  std::vector<double> limits;
  double start_m = 0.0;
  for (const RouteSegment& segment : route.segments) {
    const double end_m = start_m + segment.length_m;
    for (double s = static_cast<double>(limits.size()) * kStep_m; s < end_m; s += kStep_m) {
      const double curvature_1pm = std::max(std::abs(path.at(s).curvature_1pm), 1e-6);
      limits.push_back(
          std::min(segment.speed_mps * segment.speed_mps, kLateralAcceleration_mps2 / curvature_1pm));
    }
    start_m = end_m;
  }
  limits.push_back(0.0);
  limits.front() = 0.0;
  constexpr double kGain = 2.0 * kAcceleration_mps2 * kStep_m;
  for (std::size_t i = 1; i < limits.size(); ++i) limits[i] = std::min(limits[i], limits[i - 1] + kGain);
  for (std::size_t i = limits.size() - 1; i > 0; --i)
    limits[i - 1] = std::min(limits[i - 1], limits[i] + kGain);
  return limits;
}

}  // namespace

std::vector<double> drive_stations(const Route& route, const Path& path, double period_s) {
  const std::vector<double> squares = squared_speeds(route, path);
  // The last step is as long as is left of the route.
  const double last_step_m = path.length_m() - kStep_m * static_cast<double>(squares.size() - 2);
  const auto standing = static_cast<std::size_t>(kStanding_s / period_s);
  std::vector<double> stations_m(standing, 0.0);
  double now_s = 0.0;
  double next_sample_s = 0.0;
  for (std::size_t i = 0; i + 1 < squares.size(); ++i) {
    const double step_m = i + 2 == squares.size() ? last_step_m : kStep_m;
    const double speed_mps = std::sqrt(squares[i]);
    const double next_mps = std::sqrt(squares[i + 1]);
    const double step_s = 2.0 * step_m / (speed_mps + next_mps);
    for (; next_sample_s < now_s + step_s; next_sample_s += period_s) {
      const double t_s = next_sample_s - now_s;
      stations_m.push_back(kStep_m * static_cast<double>(i) + speed_mps * t_s +
                           0.5 * (next_mps - speed_mps) / step_s * t_s * t_s);
    }
    now_s += step_s;
  }
  stations_m.insert(stations_m.end(), standing, path.length_m());
  return moving_mean(stations_m, static_cast<std::size_t>(0.5 * kJerkTime_s / period_s));
}

}  // namespace landfix::tools::simulator
