// The NDT score: a mixture of a normal and a uniform distribution, approximated by one Gaussian.
// M. Magnusson, "The Three-Dimensional Normal-Distributions Transform", Oerebro 2009, chapter 6.
#pragma once

#include <cmath>

namespace landfix::ndt {

/// A point at squared Mahalanobis distance q from a voxel scores d1 * exp(-d2/2 * q); higher is better.
struct ScoreConstants {
  double d1 = 1.0;
  double d2 = 1.0;
};

/// Points lower than this above the vehicle's origin, frame `vehicle`, may be of the ground: it scores well
/// wherever on the road the vehicle is. The usual margin (Autoware's), but in the vehicle's frame, so that it
/// holds on slopes.
inline constexpr double kAboveGround_m = 0.8;

/// The plain exponential of the reference study: no outliers.
inline constexpr ScoreConstants kPlainExponential{};

/// `outlier_ratio` in (0, 1): the share of points that no voxel explains, 0.55 in the usual gates.
[[nodiscard]] inline ScoreConstants magnusson_constants(double outlier_ratio, double resolution_m) noexcept {
  const double c1 = 10.0 * (1.0 - outlier_ratio);
  const double c2 = outlier_ratio / (resolution_m * resolution_m * resolution_m);
  const double d3 = -std::log(c2);
  // Positive here: the thesis minimises, we maximise.
  const double d1 = std::log(c1 + c2) + d3;
  const double d2 = -2.0 * std::log((std::log(c1 * std::exp(-0.5) + c2) + d3) / d1);
  return {.d1 = d1, .d2 = d2};
}

/// `outlier_ratio` 0 means none: the plain exponential.
[[nodiscard]] inline ScoreConstants score_constants(double outlier_ratio, double resolution_m) noexcept {
  return outlier_ratio > 0.0 ? magnusson_constants(outlier_ratio, resolution_m) : kPlainExponential;
}

}  // namespace landfix::ndt
