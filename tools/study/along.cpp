#include "tools/study/along.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

namespace landfix::tools::study {

Spread spread_of(std::span<const double> values) {
  if (values.empty()) return {};
  const auto count = static_cast<double>(values.size());
  double sum = 0.0;
  for (const double value : values) sum += value;
  const double mean = sum / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {.mean = mean, .deviation = std::sqrt(squares / count)};
}

Truth::Truth(std::vector<platform::StampedPose> poses) : poses_(std::move(poses)) {
  double way_m = 0.0;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (i != 0) way_m += (poses_[i].pose.translation() - poses_[i - 1].pose.translation()).norm();
    way_m_.push_back(way_m);
  }
}

void Truth::compare(const platform::StampedPose& estimate, double iterations, Along& along) const {
  const auto truth = platform::interpolate(poses_, estimate.stamp_utc_ns);
  if (!truth) return;
  const auto after =
      std::ranges::lower_bound(poses_, estimate.stamp_utc_ns, {}, &platform::StampedPose::stamp_utc_ns);
  const auto next = static_cast<std::size_t>(std::distance(poses_.begin(), after));
  const double turn_rad = ndt::to_roll_pitch_yaw(estimate.pose.linear()).yaw_rad -
                          ndt::to_roll_pitch_yaw(truth->linear()).yaw_rad;
  const double left_m = (poses_[next].pose.translation() - truth->translation()).norm();
  along.way_m.push_back(std::max(0.0, way_m_[next] - left_m));
  along.elevation_m.push_back(estimate.pose.translation().z());
  along.true_elevation_m.push_back(truth->translation().z());
  along.position_error_m.push_back((estimate.pose.translation() - truth->translation()).norm());
  along.heading_error_deg.push_back(std::abs(std::remainder(turn_rad, 2.0 * std::numbers::pi)) /
                                    ndt::kRadians_per_deg);
  along.iterations.push_back(iterations);
}

double largest(std::span<const double> values) {
  return values.empty() ? 0.0 : *std::ranges::max_element(values);
}

double root_mean_square(std::span<const double> values) {
  if (values.empty()) return 0.0;
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

double largest_elevation_error_m(const Along& along) {
  double error_m = 0.0;
  for (std::size_t i = 0; i < along.elevation_m.size(); ++i)
    error_m = std::max(error_m, std::abs(along.elevation_m[i] - along.true_elevation_m[i]));
  return error_m;
}

}  // namespace landfix::tools::study
