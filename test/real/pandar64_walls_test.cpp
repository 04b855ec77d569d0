// The Pandar64's corrections by the walls that it saw, without any reference: channels of one height that
// look to different sides see the same walls in the same place, better with each correction than without it,
// and worse with its sign flipped.
#include <algorithm>
#include <iostream>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "real/pandar64_recording.hpp"
#include "support/test_data.hpp"

namespace landfix::drivers {
namespace {

using hesai::kPandar64;
using hesai::PandarLayout;
using test::pandar64::decode;
using test::pandar64::Decoded;
using test::pandar64::kPandar64Lasers;
using test::pandar64::unit_beams;

/// Horizontal range over azimuth, as one channel sees the room.
using Profile = std::map<double, double>;

std::vector<Profile> profiles_of(const Decoded& decoded, int sweep) {
  std::vector<Profile> profiles(kPandar64Lasers);
  const auto returns = test::to_returns(decoded.points);
  for (std::size_t i = 0; i < returns.size(); ++i) {
    if (decoded.kept[i].sweep != sweep) continue;
    const double horizontal_m =
        std::sqrt(returns[i].range_m * returns[i].range_m - returns[i].height_m * returns[i].height_m);
    profiles[decoded.kept[i].channel][returns[i].azimuth_deg] = horizontal_m;
  }
  return profiles;
}

/// How far apart two profiles are where both see the same wall, point by point, when `b` is turned by
/// `shift_deg`; what one sees and the other does not counts little.
std::vector<double> distances_m(const Profile& a, const Profile& b, double shift_deg) {
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

double mean_distance_m(const Profile& a, const Profile& b, double shift_deg) {
  const auto distances = distances_m(a, b, shift_deg);
  const double sum_m = std::accumulate(distances.begin(), distances.end(), 0.0);
  return distances.empty() ? 1.0 : sum_m / static_cast<double>(distances.size());
}

/// Calls `use` with every two channels of nearly one height that look to different sides.
template <class Use>
void for_each_pair(std::span<const Beam> beams, Use use) {
  int pairs = 0;
  for (std::size_t a = 0; a < beams.size(); ++a) {
    for (std::size_t b = a + 1; b < beams.size(); ++b) {
      if (std::abs(beams[a].elevation_deg - beams[b].elevation_deg) > 0.2) continue;
      if (std::abs(beams[a].azimuth_offset_deg - beams[b].azimuth_offset_deg) < 1.0) continue;
      use(a, b);
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 20);
}

/// How far such channels disagree about the azimuth of the same walls.
double misalignment_rms_deg(const std::vector<Profile>& profiles, std::span<const Beam> beams) {
  double squares = 0.0;
  int pairs = 0;
  for_each_pair(beams, [&](std::size_t a, std::size_t b) {
    double best_deg = 0.0;
    double best_m = 1.0;
    for (double shift_deg = -0.4; shift_deg <= 0.4; shift_deg += 0.01) {
      const double distance_m = mean_distance_m(profiles[a], profiles[b], shift_deg);
      if (distance_m < best_m) std::tie(best_m, best_deg) = std::pair(distance_m, shift_deg);
    }
    squares += best_deg * best_deg;
    ++pairs;
  });
  return std::sqrt(squares / std::max(pairs, 1));
}

/// Share of the returns that such channels have within 2 cm of each other.
double agreement(const std::vector<Profile>& profiles, std::span<const Beam> beams) {
  std::size_t close = 0;
  std::size_t all = 0;
  for_each_pair(beams, [&](std::size_t a, std::size_t b) {
    const auto distances = distances_m(profiles[a], profiles[b], 0.0);
    all += distances.size();
    close += static_cast<std::size_t>(
        std::ranges::count_if(distances, [](double distance_m) { return distance_m < 0.02; }));
  });
  return static_cast<double>(close) / static_cast<double>(std::max<std::size_t>(all, 1));
}

TEST(Pandar64RealData, TheCorrectionsMakeNeighbouringChannelsSeeTheSameWalls) {
  LANDFIX_REAL_DATA(capture, "pandar64/capture.pcap");
  LANDFIX_REAL_DATA(calibration, "pandar64/calibration.csv");
  const auto beams = unit_beams(calibration);
  auto fired_after = beams;
  for (Beam& beam : fired_after) beam.firing_time_us = -beam.firing_time_us;
  PandarLayout other_side = kPandar64;
  other_side.optical_centre_m = {.x = -kPandar64.optical_centre_m.x, .y = -kPandar64.optical_centre_m.y};
  const auto misalignment_deg = [&](std::span<const Beam> decoded_with, const DecoderOptions& options,
                                    const PandarLayout& layout = kPandar64) {
    return misalignment_rms_deg(profiles_of(decode(capture, decoded_with, options, layout), 2), beams);
  };
  const double neither = misalignment_deg(beams, {.firing_time_azimuth = false, .optical_centre = false});
  const double firing_times = misalignment_deg(beams, {.optical_centre = false});
  const double centre = misalignment_deg(beams, {.firing_time_azimuth = false});
  const double both = misalignment_deg(beams, {});
  const double times_flipped = misalignment_deg(fired_after, {});
  const double centre_flipped = misalignment_deg(beams, {}, other_side);
  std::cout << "rms misalignment: neither " << neither << " deg, firing times " << firing_times
            << " deg, centre " << centre << " deg, both " << both << " deg, firing times flipped "
            << times_flipped << " deg, centre flipped " << centre_flipped << " deg\n";
  EXPECT_LT(centre, neither);
  EXPECT_LT(both, centre);
  EXPECT_LT(both, 0.75 * neither);
  EXPECT_LT(both, 0.75 * times_flipped);
  EXPECT_LT(both, 0.75 * centre_flipped);
}

TEST(Pandar64RealData, TheAzimuthOffsetsMakeNeighbouringChannelsSeeTheSameWalls) {
  LANDFIX_REAL_DATA(capture, "pandar64/capture.pcap");
  LANDFIX_REAL_DATA(calibration, "pandar64/calibration.csv");
  const auto beams = unit_beams(calibration);
  const auto agreement_with = [&](double factor) {
    auto changed = beams;
    for (Beam& beam : changed) beam.azimuth_offset_deg *= factor;
    return agreement(profiles_of(decode(capture, changed, {}), 2), beams);
  };
  const double right = agreement_with(1.0);
  const double without = agreement_with(0.0);
  const double flipped = agreement_with(-1.0);
  std::cout << "within 2 cm of the neighbour: with offsets " << right << ", without " << without
            << ", flipped " << flipped << "\n";
  EXPECT_GT(right, 1.5 * without);
  EXPECT_GT(without, flipped);
}

}  // namespace
}  // namespace landfix::drivers
