// The Pandar64's corrections by the walls that it saw, without any reference: channels of one height that
// look to different sides see the same walls in the same place, better with each correction than without it,
// and worse with its sign flipped.
#include <cmath>
#include <iostream>
#include <vector>

#include "real/pandar64_recording.hpp"
#include "real/wall_profiles.hpp"
#include "support/test_data.hpp"

namespace landfix::drivers {
namespace {

using hesai::kPandar64;
using hesai::PandarLayout;
using test::Profile;
using test::pandar64::decode;
using test::pandar64::Decoded;
using test::pandar64::kPandar64Lasers;
using test::pandar64::unit_beams;

/// Channels of nearly one height.
constexpr double kMostApartDeg = 0.2;

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
    return test::misalignment_rms_deg(profiles_of(decode(capture, decoded_with, options, layout), 2), beams,
                                      kMostApartDeg);
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
    return test::agreement(profiles_of(decode(capture, changed, {}), 2), beams, kMostApartDeg);
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
