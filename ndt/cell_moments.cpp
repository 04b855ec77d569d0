#include "ndt/cell_moments.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

namespace landfix::ndt {
namespace {

/// What a lidar's ranges scatter by: among smooth walls, none is smoother.
constexpr double kRangeNoise_m = 0.02;

}  // namespace

float entropy_of(const CellMoments& moments, const Eigen::Vector3d& mean_place, std::uint32_t points,
                 double leaf_m) noexcept {
  if (points < kLeastPointsOfEntropy) return std::numeric_limits<float>::quiet_NaN();
  const auto mean_of = [&](std::size_t i) {
    return std::ldexp(static_cast<double>(moments[i]) / points, -2 * kPlaceBits);
  };
  Eigen::Matrix3d products;
  products << mean_of(0), mean_of(1), mean_of(2),  //
      mean_of(1), mean_of(3), mean_of(4),          //
      mean_of(2), mean_of(4), mean_of(5);
  const Eigen::Matrix3d covariance_m2 = leaf_m * leaf_m * (products - mean_place * mean_place.transpose()) +
                                        kRangeNoise_m * kRangeNoise_m * Eigen::Matrix3d::Identity();
  constexpr double kTwoPiE = 2.0 * std::numbers::pi * std::numbers::e;
  return static_cast<float>(0.5 * std::log(kTwoPiE * kTwoPiE * kTwoPiE * covariance_m2.determinant()));
}

}  // namespace landfix::ndt
