// The VLP-16's firing-time rotation, by the walls that recorded sensors saw.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "real/cloud_comparison.hpp"
#include "support/test_data.hpp"

namespace landfix::drivers {
namespace {

/// Azimuth and horizontal range of the returns of each ring.
using Rings = std::map<unsigned, std::vector<std::pair<double, double>>>;

/// How far returns lie from the line between their two neighbours in azimuth, on average [m]. Both firing
/// sequences of a block carry one azimuth: unless the second is turned on by its 0.2 deg, and the right way,
/// it does not fit between its neighbours on any surface that is not square to the beam.
double roughness_m(Rings rings) {
  constexpr double kMostM = 0.1;
  double sum_m = 0.0;
  std::size_t count = 0;
  for (auto& [ring, returns] : rings) {
    std::sort(returns.begin(), returns.end());
    for (std::size_t i = 1; i + 1 < returns.size(); ++i) {
      const auto& [before_deg, before_m] = returns[i - 1];
      const auto& [after_deg, after_m] = returns[i + 1];
      const double gap_deg = after_deg - before_deg;
      if (gap_deg <= 0.0 || gap_deg > 0.6 || std::abs(after_m - before_m) > 0.5) continue;
      const double part = (returns[i].first - before_deg) / gap_deg;
      sum_m += std::min(std::abs(before_m + part * (after_m - before_m) - returns[i].second), kMostM);
      ++count;
    }
  }
  EXPECT_GT(count, 10'000U);
  return sum_m / static_cast<double>(std::max<std::size_t>(count, 1));
}

/// The second whole sweep with the rotation times `factor`.
double roughness_m(const std::vector<test::RecordedPacket>& packets, double factor) {
  const auto turned = test::decode_sweeps("vlp16", packets, {}).at(2).points;
  const auto at_rest = test::to_returns(
      test::decode_sweeps("vlp16", packets, DecoderOptions{.firing_time_azimuth = false}).at(2).points);
  const auto returns = test::to_returns(turned);
  Rings rings;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const double rotation_deg = std::remainder(returns[i].azimuth_deg - at_rest[i].azimuth_deg, 360.0);
    const double height_m = returns[i].height_m;
    rings[turned[i].ring].emplace_back(
        at_rest[i].azimuth_deg + factor * rotation_deg,
        std::sqrt(returns[i].range_m * returns[i].range_m - height_m * height_m));
  }
  return roughness_m(std::move(rings));
}

TEST(Vlp16RealData, TheRotationMakesSurfacesSmooth) {
  for (const char* const capture : {"vlp16/moving.pcap", "vlp16/dual-return.pcap"}) {
    LANDFIX_REAL_DATA(path, capture);
    const auto packets = test::read_packets(path, 2368);
    const double right_m = roughness_m(packets, 1.0);
    const double without_m = roughness_m(packets, 0.0);
    const double flipped_m = roughness_m(packets, -1.0);
    const double doubled_m = roughness_m(packets, 2.0);
    std::cout << capture << ": roughness " << 1e3 * right_m << " mm, without the rotation " << 1e3 * without_m
              << " mm, flipped " << 1e3 * flipped_m << " mm, doubled " << 1e3 * doubled_m << " mm\n";
    EXPECT_GT(without_m, 1.25 * right_m);
    EXPECT_GT(flipped_m, without_m);
    EXPECT_GT(doubled_m, 1.25 * right_m);
  }
}

}  // namespace
}  // namespace landfix::drivers
