// When a match is believed: how well the map explains the scan at the pose that was found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "ndt/matcher.hpp"

namespace landfix::ndt {

/// Likelihoods are shares of the best score that a point can have (ScoreConstants::d1), so that they hold at
/// any resolution: the usual gate of the nearest voxel likelihood, 2.3 at 2 m, is 0.55. Of what stands in the
/// scan, 731 right matches on the simulated routes and a real drive had 0.58 or more explained; of 5,743 that
/// began 4 to 30 m away and ended elsewhere none had more than 0.39, most less than 0.1.
struct FitGates {
  // To be believed.
  double believed_likelihood = 0.3;
  double believed_standing_explained = 0.15;
  std::size_t believed_points = 50;  ///< fewer fit anywhere
  // To be good.
  double good_likelihood = 0.55;
  double good_matched_share = 0.5;  ///< of the points, those with a voxel near
  double good_standing_explained = 0.5;
  std::size_t good_points = 100;
  double good_sigma_m = 0.05;  ///< along each axis
};

enum class Fit : std::uint8_t {
  none,  ///< the pose is not to be believed
  weak,
  good,
};
[[nodiscard]] std::string_view to_string(Fit fit) noexcept;
[[nodiscard]] Fit judge(const MatchResult& match, const FitGates& gates) noexcept;

}  // namespace landfix::ndt
