// The Pandar64's recorded packets against the cloud that another driver decoded from them.
#include <algorithm>
#include <iostream>

#include "real/pandar64_recording.hpp"
#include "support/test_data.hpp"

namespace landfix::drivers {
namespace {

using test::Differences;
using test::Return;
using test::pandar64::decode;
using test::pandar64::Decoded;
using test::pandar64::unit_beams;

/// Our points of one of the reference's sweeps, in its order.
std::vector<Return> sweep_as_the_reference(const Decoded& decoded, int sweep) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < decoded.kept.size(); ++i) {
    if (decoded.kept[i].sweep == sweep) chosen.push_back(i);
  }
  std::ranges::sort(chosen, {}, [&](std::size_t i) { return decoded.kept[i].order(); });
  std::vector<Point> points;
  for (const std::size_t i : chosen) points.push_back(decoded.points.at(i));
  return test::to_returns(points);
}

/// The reference's axes: y forward, x right.
std::vector<Return> read_reference(const std::filesystem::path& path) {
  constexpr std::string_view kColumns[] = {"x", "y", "z"};
  std::vector<Return> returns;
  for (const auto& row : test::read_pcd(path, kColumns)) {
    returns.push_back(test::to_return(row[1], -row[0], row[2], 0.0));
  }
  return returns;
}

struct Case {
  const char* name;
  DecoderOptions options;
  double azimuth_deg;  ///< largest difference that is allowed
};

TEST(Pandar64RealData, AgreesWithTheReference) {
  LANDFIX_REAL_DATA(capture, "pandar64/capture.pcap");
  LANDFIX_REAL_DATA(reference, "pandar64/capture-sweep.pcd");
  LANDFIX_REAL_DATA(calibration, "pandar64/calibration.csv");
  const auto beams = unit_beams(calibration);
  const auto theirs = read_reference(reference);
  const Case cases[] = {
      // Without the two corrections that the reference lacks nothing is left between us;
      {"neither correction", {.firing_time_azimuth = false, .optical_centre = false}, 1e-4},
      // a laser fires up to 54.7 us before the end of its block.
      {"firing times", {.optical_centre = false}, 0.2},
  };
  for (const Case& a_case : cases) {
    const Decoded decoded = decode(capture, beams, a_case.options);
    ASSERT_EQ(decoded.points.size(), decoded.kept.size());
    const auto ours = sweep_as_the_reference(decoded, 3);
    ASSERT_EQ(ours.size(), theirs.size());
    const Differences most = test::compare(ours, theirs);
    std::cout << a_case.name << ", most: range " << most.range_m << " m, height " << most.height_m
              << " m, azimuth " << most.azimuth_deg << " deg, rms " << most.azimuth_rms_deg << " deg\n";
    EXPECT_LT(most.range_m, 1e-3) << a_case.name;
    EXPECT_LT(most.height_m, 1e-3) << a_case.name;
    EXPECT_LT(most.azimuth_deg, a_case.azimuth_deg) << a_case.name;
  }
}

}  // namespace
}  // namespace landfix::drivers
