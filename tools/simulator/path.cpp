#include "tools/simulator/path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace landfix::tools::simulator {
namespace {

constexpr double kKnotSpacing_m = 0.25;
constexpr double kLeadIn_m = 80.0;
// Two passes of a moving mean turn a step into an S over twice this length: a clothoid with rounded ends, and
// for the grade a vertical curve.
constexpr double kCurveTransition_m = 10.0;
constexpr double kGradeTransition_m = 14.0;

std::size_t half_width(double length_m) { return static_cast<std::size_t>(length_m / kKnotSpacing_m / 2.0); }

std::vector<double> smoothed(std::vector<double> values, double length_m) {
  return moving_mean(moving_mean(values, half_width(length_m)), half_width(length_m));
}

Eigen::Vector3d tangent(double heading_rad, double slope_rad) {
  return {std::cos(slope_rad) * std::cos(heading_rad), std::cos(slope_rad) * std::sin(heading_rad),
          std::sin(slope_rad)};
}

/// Value and slope at both ends of an interval of length h; `u` in [0, 1] across it.
template <class T>
T hermite(const T& a, const T& a_slope, const T& b, const T& b_slope, double h, double u) {
  const double u2 = u * u;
  const double u3 = u2 * u;
  return (2.0 * u3 - 3.0 * u2 + 1.0) * a + (u3 - 2.0 * u2 + u) * h * a_slope + (3.0 * u2 - 2.0 * u3) * b +
         (u3 - u2) * h * b_slope;
}

}  // namespace

std::vector<double> moving_mean(const std::vector<double>& values, std::size_t half_width) {
  const auto at = [&values](std::ptrdiff_t i) {
    return values[static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(i, 0, static_cast<std::ptrdiff_t>(values.size()) - 1))];
  };
  const auto reach = static_cast<std::ptrdiff_t>(half_width);
  double sum = 0.0;
  for (std::ptrdiff_t i = -reach; i <= reach; ++i) sum += at(i);
  std::vector<double> means;
  means.reserve(values.size());
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(values.size()); ++i) {
    means.push_back(sum / static_cast<double>(2 * half_width + 1));
    sum += at(i + reach + 1) - at(i - reach);
  }
  return means;
}

Eigen::Vector2d PathPoint::forward() const noexcept { return {std::cos(heading_rad), std::sin(heading_rad)}; }
Eigen::Vector2d PathPoint::left() const noexcept { return {-std::sin(heading_rad), std::cos(heading_rad)}; }

Path::Path(const Route& route) : length_m_(route.length_m()) {
  const auto count = static_cast<std::size_t>(std::ceil((length_m_ + 2.0 * kLeadIn_m) / kKnotSpacing_m)) + 1;
  std::vector<double> curvatures_1pm(count, 0.0);
  std::vector<double> slopes_rad(count, 0.0);
  double end_m = kLeadIn_m;
  auto knot = static_cast<std::size_t>(kLeadIn_m / kKnotSpacing_m);
  for (const RouteSegment& segment : route.segments) {
    end_m += segment.length_m;
    for (; static_cast<double>(knot) * kKnotSpacing_m < end_m; ++knot) {
      curvatures_1pm[knot] = segment.curvature_1pm;
      slopes_rad[knot] = std::atan(segment.grade);
    }
  }
  curvatures_1pm = smoothed(std::move(curvatures_1pm), kCurveTransition_m);
  slopes_rad = smoothed(std::move(slopes_rad), kGradeTransition_m);

  knots_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    knots_[i].slope_rad = slopes_rad[i];
    knots_[i].curvature_1pm = curvatures_1pm[i];
    if (i == 0) continue;
    const PathPoint& before = knots_[i - 1];
    const double half_turn_rad = 0.25 * kKnotSpacing_m * (before.curvature_1pm + knots_[i].curvature_1pm);
    knots_[i].heading_rad = before.heading_rad + 2.0 * half_turn_rad;
    // Simpson's rule over the interval.
    const Eigen::Vector3d mean =
        (tangent(before.heading_rad, before.slope_rad) +
         4.0 * tangent(before.heading_rad + half_turn_rad, 0.5 * (before.slope_rad + knots_[i].slope_rad)) +
         tangent(knots_[i].heading_rad, knots_[i].slope_rad)) /
        6.0;
    knots_[i].position_m = before.position_m + kKnotSpacing_m * mean;
  }

  // So far the lead-in begins at the origin, along x; the drive shall, with the route's heading.
  const PathPoint start = at(0.0);
  const double turn_rad = route.heading_deg * std::numbers::pi / 180.0 - start.heading_rad;
  const Eigen::AngleAxisd turn(turn_rad, Eigen::Vector3d::UnitZ());
  for (PathPoint& point : knots_) {
    point.position_m = turn * (point.position_m - start.position_m);
    point.heading_rad += turn_rad;
  }
}

PathPoint Path::at(double station_m) const noexcept {
  const double place =
      std::clamp((station_m + kLeadIn_m) / kKnotSpacing_m, 0.0, static_cast<double>(knots_.size() - 1));
  const std::size_t i = std::min(static_cast<std::size_t>(place), knots_.size() - 2);
  const double u = place - static_cast<double>(i);
  const PathPoint& a = knots_[i];
  const PathPoint& b = knots_[i + 1];
  return {
      .position_m = hermite<Eigen::Vector3d>(a.position_m, tangent(a.heading_rad, a.slope_rad), b.position_m,
                                             tangent(b.heading_rad, b.slope_rad), kKnotSpacing_m, u),
      .heading_rad =
          hermite(a.heading_rad, a.curvature_1pm, b.heading_rad, b.curvature_1pm, kKnotSpacing_m, u),
      .slope_rad = a.slope_rad + u * (b.slope_rad - a.slope_rad),
      .curvature_1pm = a.curvature_1pm + u * (b.curvature_1pm - a.curvature_1pm),
  };
}

// NOLINTNEXTLINE(readability-convert-member-functions-to-static): it goes with last_station_m
double Path::first_station_m() const noexcept { return -kLeadIn_m; }
double Path::last_station_m() const noexcept {
  return static_cast<double>(knots_.size() - 1) * kKnotSpacing_m - kLeadIn_m;
}

}  // namespace landfix::tools::simulator
