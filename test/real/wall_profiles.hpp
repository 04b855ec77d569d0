// Walls as single channels see them: corrections that are right make channels of one height, which look to
// different sides, see the same walls in the same place. No reference is needed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/beam.hpp"

namespace landfix::test {

/// Horizontal range over azimuth, as one channel sees the room.
using Profile = std::map<double, double>;

/// How far apart two profiles are where both see the same wall, point by point, when `b` is turned by
/// `shift_deg`; what one sees and the other does not counts little.
inline std::vector<double> distances_m(const Profile& a, const Profile& b, double shift_deg) {
  constexpr double kMostM = 0.2;
  std::vector<double> distances;
  for (const auto& [azimuth_deg, range_m] : b) {
    const auto after = a.lower_bound(azimuth_deg + shift_deg);
    if (after == a.begin() || after == a.end()) continue;
    const auto before = std::prev(after);
    const double gap_deg = after->first - before->first;
    if (gap_deg > 0.5 || std::abs(after->second - before->second) > kMostM) continue;
    const double part = (azimuth_deg + shift_deg - before->first) / gap_deg;
    const double expected_m = before->second + part * (after->second - before->second);
    distances.push_back(std::min(std::abs(expected_m - range_m), kMostM));
  }
  return distances;
}

/// By how much `b` is to be turned to agree best with `a`: up to `steps` times `step_deg` either way. Nothing
/// where they never see `least_common` points of the same walls.
inline std::optional<double> best_shift_deg(const Profile& a, const Profile& b, int steps, double step_deg,
                                            std::size_t least_common) {
  std::optional<double> best_deg;
  double best_m = std::numeric_limits<double>::infinity();
  for (int step = -steps; step <= steps; ++step) {
    const double shift_deg = step * step_deg;
    const auto distances = distances_m(a, b, shift_deg);
    if (distances.size() < least_common) continue;
    const double mean_m =
        std::accumulate(distances.begin(), distances.end(), 0.0) / static_cast<double>(distances.size());
    if (mean_m >= best_m) continue;
    best_m = mean_m;
    best_deg = shift_deg;
  }
  return best_deg;
}

/// Calls `use` with every two channels of nearly one height, at most `most_apart_deg` apart, that look to
/// different sides.
template <class Use>
void for_each_pair(std::span<const drivers::Beam> beams, double most_apart_deg, Use use) {
  int pairs = 0;
  for (std::size_t a = 0; a < beams.size(); ++a) {
    for (std::size_t b = a + 1; b < beams.size(); ++b) {
      if (std::abs(beams[a].elevation_deg - beams[b].elevation_deg) > most_apart_deg) continue;
      if (std::abs(beams[a].azimuth_offset_deg - beams[b].azimuth_offset_deg) < 1.0) continue;
      use(a, b);
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 20);
}

/// How far such channels disagree about the azimuth of the same walls.
inline double misalignment_rms_deg(const std::vector<Profile>& profiles, std::span<const drivers::Beam> beams,
                                   double most_apart_deg) {
  double squares = 0.0;
  int pairs = 0;
  for_each_pair(beams, most_apart_deg, [&](std::size_t a, std::size_t b) {
    const double apart_deg = best_shift_deg(profiles[a], profiles[b], 40, 0.01, 1).value_or(0.0);
    squares += apart_deg * apart_deg;
    ++pairs;
  });
  return std::sqrt(squares / std::max(pairs, 1));
}

/// Share of the returns that such channels have within 2 cm of each other.
inline double agreement(const std::vector<Profile>& profiles, std::span<const drivers::Beam> beams,
                        double most_apart_deg) {
  std::size_t close = 0;
  std::size_t all = 0;
  for_each_pair(beams, most_apart_deg, [&](std::size_t a, std::size_t b) {
    const auto distances = distances_m(profiles[a], profiles[b], 0.0);
    all += distances.size();
    close += static_cast<std::size_t>(
        std::ranges::count_if(distances, [](double distance_m) { return distance_m < 0.02; }));
  });
  return static_cast<double>(close) / static_cast<double>(std::max<std::size_t>(all, 1));
}

}  // namespace landfix::test
