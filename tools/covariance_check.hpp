// Whether the covariances of a replay are what its errors are.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "ndt/pose.hpp"
#include "platform/pipeline.hpp"

namespace landfix::tools {

/// Mean squares, each of an error over what its covariance says: 1 where that is right, NaN of no sweep.
struct CovarianceCheck {
  std::size_t sweeps = 0;           ///< matched, within the truth's time
  double per_degree_of_freedom{};   ///< normalised estimation error squared, over 6
  std::array<double, 6> by_axis{};  ///< x y z roll pitch yaw, each by itself
};

[[nodiscard]] CovarianceCheck check_covariances(std::span<const platform::SweepResult> sweeps,
                                                std::span<const ndt::StampedPose> truth);

}  // namespace landfix::tools
