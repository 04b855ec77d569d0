#include "platform/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fmt/format.h>

namespace landfix::platform {
namespace {

// Positions that spread less than this across their main direction do not say how to turn about it.
constexpr double kMinSpread_m = 1e-3;

struct Pair {
  std::int64_t stamp_utc_ns;
  ndt::Pose reference;
  ndt::Pose estimate;
};

std::vector<Pair> associate(std::span<const StampedPose> reference, std::span<const StampedPose> estimate) {
  std::vector<Pair> pairs;
  pairs.reserve(estimate.size());
  for (const StampedPose& pose : estimate) {
    if (const auto truth = interpolate(reference, pose.stamp_utc_ns)) {
      pairs.push_back({.stamp_utc_ns = pose.stamp_utc_ns, .reference = *truth, .estimate = pose.pose});
    }
  }
  return pairs;
}

std::string span_of(std::span<const StampedPose> poses) {
  if (poses.empty()) return "empty";
  return fmt::format("{:.3f} s to {:.3f} s", static_cast<double>(poses.front().stamp_utc_ns) * 1e-9,
                     static_cast<double>(poses.back().stamp_utc_ns) * 1e-9);
}

ndt::Pose least_squares_alignment(std::span<const Pair> pairs) {
  const auto count = static_cast<Eigen::Index>(pairs.size());
  Eigen::Matrix3Xd from(3, count);
  Eigen::Matrix3Xd to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    from.col(i) = pairs[static_cast<std::size_t>(i)].estimate.translation();
    to.col(i) = pairs[static_cast<std::size_t>(i)].reference.translation();
  }
  for (const Eigen::Matrix3Xd* const positions : {&from, &to}) {
    const Eigen::Matrix3Xd centred = positions->colwise() - positions->rowwise().mean();
    const Eigen::Matrix3d covariance = centred * centred.transpose() / static_cast<double>(count);
    const double second = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues()[1];
    if (std::sqrt(std::max(second, 0.0)) < kMinSpread_m) {
      throw std::runtime_error(
          "se3: the positions lie on a line, which leaves a rotation open; align first instead");
    }
  }
  return ndt::Pose(Eigen::umeyama(from, to, false));
}

ndt::Pose alignment(std::span<const Pair> pairs, Alignment alignment) {
  switch (alignment) {
    case Alignment::none:
      break;
    case Alignment::first:
      return pairs.front().reference * pairs.front().estimate.inverse();
    case Alignment::se3:
      return least_squares_alignment(pairs);
  }
  return ndt::Pose::Identity();
}

/// Of magnitudes.
ErrorStatistics statistics(std::vector<double> errors) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  if (errors.empty()) return {.rmse = kNan, .mean = kNan, .median = kNan, .max = kNan};
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  const std::size_t middle = errors.size() / 2;
  const double squares = std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0);
  return {.rmse = std::sqrt(squares / count),
          .mean = std::accumulate(errors.begin(), errors.end(), 0.0) / count,
          .median = errors.size() % 2 == 1 ? errors[middle] : 0.5 * (errors[middle - 1] + errors[middle]),
          .max = errors.back()};
}

/// Over the shorter way round.
double turn_deg(double from_rad, double to_rad) {
  return std::abs(std::remainder(to_rad - from_rad, 2.0 * M_PI)) / ndt::kRadians_per_deg;
}

double angle_deg(const ndt::Pose& a, const ndt::Pose& b) {
  return ndt::angle_between(a, b) / ndt::kRadians_per_deg;
}

template <class Measure>
ErrorStatistics measure(std::span<const Pair> pairs, Measure error) {
  std::vector<double> errors;
  errors.reserve(pairs.size());
  for (const Pair& pair : pairs) errors.push_back(error(pair.reference, pair.estimate));
  return statistics(std::move(errors));
}

template <class Angle>
ErrorStatistics measure_angle(std::span<const Pair> pairs, Angle angle) {
  return measure(pairs, [angle](const ndt::Pose& reference, const ndt::Pose& estimate) {
    return turn_deg(ndt::to_roll_pitch_yaw(reference.linear()).*angle,
                    ndt::to_roll_pitch_yaw(estimate.linear()).*angle);
  });
}

/// The motion from each pose to the one that is nearest to `delta_ns` later, if it is within a tenth of it.
std::vector<Pair> motions(std::span<const Pair> pairs, std::int64_t delta_ns) {
  std::vector<Pair> result;
  std::size_t end = 0;
  for (const Pair& begin : pairs) {
    const auto distance_ns = [&](std::size_t i) {
      return std::abs(pairs[i].stamp_utc_ns - begin.stamp_utc_ns - delta_ns);
    };
    while (end + 1 < pairs.size() && distance_ns(end + 1) <= distance_ns(end)) ++end;
    if (distance_ns(end) > delta_ns / 10) continue;
    result.push_back({.stamp_utc_ns = begin.stamp_utc_ns,
                      .reference = begin.reference.inverse() * pairs[end].reference,
                      .estimate = begin.estimate.inverse() * pairs[end].estimate});
  }
  return result;
}

}  // namespace

Evaluation evaluate(std::span<const StampedPose> reference, std::span<const StampedPose> estimate,
                    const EvaluationOptions& options) {
  std::vector<Pair> pairs = associate(reference, estimate);
  if (pairs.empty()) {
    throw std::runtime_error(fmt::format(
        "no pose of the estimate ({}) lies within the reference's time ({}); both must be on one clock",
        span_of(estimate), span_of(reference)));
  }
  const ndt::Pose reference_from_estimate = alignment(pairs, options.alignment);
  for (Pair& pair : pairs) pair.estimate = reference_from_estimate * pair.estimate;
  const std::vector<Pair> moved = motions(pairs, options.delta_ns);

  const auto distance_m = [](const ndt::Pose& a, const ndt::Pose& b) {
    return (a.translation() - b.translation()).norm();
  };
  const auto motion_distance_m = [](const ndt::Pose& a, const ndt::Pose& b) {
    return (a.inverse() * b).translation().norm();
  };
  const auto elevation_m = [](const ndt::Pose& a, const ndt::Pose& b) {
    return std::abs(a.translation().z() - b.translation().z());
  };
  return {.pairs = pairs.size(),
          .unmatched = estimate.size() - pairs.size(),
          .ate_m = measure(pairs, distance_m),
          .ate_deg = measure(pairs, angle_deg),
          .roll_deg = measure_angle(pairs, &ndt::RollPitchYaw::roll_rad),
          .pitch_deg = measure_angle(pairs, &ndt::RollPitchYaw::pitch_rad),
          .heading_deg = measure_angle(pairs, &ndt::RollPitchYaw::yaw_rad),
          .elevation_m = measure(pairs, elevation_m),
          .rpe_pairs = moved.size(),
          .rpe_m = measure(moved, motion_distance_m),
          .rpe_deg = measure(moved, angle_deg)};
}

}  // namespace landfix::platform
