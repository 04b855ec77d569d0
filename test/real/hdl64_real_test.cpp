// The recorded packets of an HDL-64E S1 against the cloud of the vendor's viewer, and its calibration against
// the walls that it saw.
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <set>
#include <sstream>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "drivers/velodyne/hdl64_calibration_file.hpp"
#include "real/cloud_comparison.hpp"
#include "support/test_data.hpp"

namespace landfix::drivers {
namespace {

using velodyne::Hdl64Calibration;
using velodyne::Hdl64Laser;

struct Decoded {
  std::vector<std::vector<Point>> sweeps;  ///< the last one is what was left
  std::array<std::uint64_t, kDecodeStatusCount> packets{};
};

Decoded decode(std::span<const test::RecordedPacket> packets, const Hdl64Calibration& calibration,
               const DecoderOptions& options) {
  const SensorModel& model = *find_sensor_model("hdl64s1");
  AnyDecoder decoder = make_decoder(model, options, calibration);
  std::vector<Point> storage(2 * model.max_points_per_sweep());
  SweepPair sweeps(storage);
  Decoded decoded;
  const auto keep = [&] {
    decoded.sweeps.emplace_back(sweeps.completed().points().begin(), sweeps.completed().points().end());
  };
  for (const test::RecordedPacket& packet : packets) {
    const DecodeResult result = decoder.decode(packet.view(), sweeps);
    ++decoded.packets[static_cast<std::size_t>(result.status)];
    if (result.sweep_completed) keep();
  }
  EXPECT_EQ(decoder.counters().lost_packets, 0U);
  if (decoder.flush(sweeps)) keep();
  return decoded;
}

Hdl64Calibration calibration_of(const std::filesystem::path& path) {
  return velodyne::parse_hdl64_calibration(platform::read_file(path), path.string());
}

/// The viewer's cloud: x right, y forward.
std::vector<Point> read_reference(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);  // header
  std::vector<Point> points;
  while (std::getline(file, line)) {
    std::istringstream row(line);
    double right_m = 0.0;
    double forward_m = 0.0;
    double up_m = 0.0;
    double intensity = 0.0;
    char comma = 0;
    row >> right_m >> comma >> forward_m >> comma >> up_m >> comma >> intensity;
    points.push_back({.x = static_cast<float>(forward_m),
                      .y = static_cast<float>(-right_m),
                      .z = static_cast<float>(up_m),
                      .intensity = static_cast<float>(intensity)});
  }
  return points;
}

struct Apart {
  double median_m = 0.0;
  double most_m = 0.0;
};

Apart apart(std::span<const Point> ours, std::span<const Point> theirs) {
  std::vector<double> distances_m;
  for (std::size_t i = 0; i < std::min(ours.size(), theirs.size()); ++i) {
    distances_m.push_back(
        std::hypot(ours[i].x - theirs[i].x, ours[i].y - theirs[i].y, ours[i].z - theirs[i].z));
  }
  std::ranges::sort(distances_m);
  return {distances_m.at(distances_m.size() / 2), distances_m.back()};
}

TEST(Hdl64RealData, ReproducesTheVendorsViewer) {
  LANDFIX_REAL_DATA(capture, "hdl64e/s1-at-wall.pcap");
  LANDFIX_REAL_DATA(file, "hdl64e/s1-db.xml");
  LANDFIX_REAL_DATA(reference, "hdl64e/s1-at-wall-sweep.csv");
  const auto packets = test::read_packets(capture, 2368);
  const auto calibration = calibration_of(file);
  const auto theirs = read_reference(reference);
  ASSERT_EQ(theirs.size(), 89'105U);

  struct Case {
    const char* name;
    DecoderOptions options;
    double least_median_m;
    double median_m;
    double most_m;
  };
  const Case cases[] = {
      // The viewer has neither correction: nothing is left between us but the last digit of a float;
      {"neither", {.firing_time_azimuth = false, .two_point_correction = false}, 0.0, 3e-6, 2e-5},
      // the corrections of this unit differ near and far by up to 11 cm,
      {"two-point", {.firing_time_azimuth = false}, 0.01, 0.03, 0.15},
      // and its rotor turns 0.11 deg while a block fires.
      {"firing times", {.two_point_correction = false}, 1e-3, 0.03, 0.25},
  };
  for (const Case& a_case : cases) {
    const Decoded decoded = decode(packets, calibration, a_case.options);
    EXPECT_EQ(decoded.packets[static_cast<std::size_t>(DecodeStatus::decoded)], 306U);
    EXPECT_EQ(decoded.packets[static_cast<std::size_t>(DecodeStatus::wrong_size)], 1U);
    ASSERT_GE(decoded.sweeps.size(), 2U);
    const auto& ours = decoded.sweeps[1];
    ASSERT_EQ(ours.size(), theirs.size());
    for (std::size_t i = 0; i < ours.size(); ++i) ASSERT_EQ(ours[i].intensity, theirs[i].intensity);
    const Apart result = apart(ours, theirs);
    std::cout << a_case.name << ": median " << result.median_m << " m, most " << result.most_m << " m\n";
    EXPECT_GE(result.median_m, a_case.least_median_m) << a_case.name;
    EXPECT_LT(result.median_m, a_case.median_m) << a_case.name;
    EXPECT_LT(result.most_m, a_case.most_m) << a_case.name;
  }
}

/// How uneven the surfaces are on which the lasers must agree: in cubes of 1 m that at least ten of them see,
/// the rms distance of the points from the plane that fits them best; of these the median.
double unevenness_m(std::span<const Point> points) {
  struct Cube {
    std::vector<Eigen::Vector3d> points_m;
    std::set<std::uint16_t> rings;
  };
  std::map<std::array<int, 3>, Cube> cubes;
  for (const Point& point : points) {
    const auto index = [](float metres) { return static_cast<int>(std::floor(metres)); };
    Cube& cube = cubes[{index(point.x), index(point.y), index(point.z)}];
    cube.points_m.push_back(Eigen::Vector3f(point.x, point.y, point.z).cast<double>());
    cube.rings.insert(point.ring);
  }
  std::vector<double> distances_m;
  for (const auto& [index, cube] : cubes) {
    if (cube.rings.size() < 10 || cube.points_m.size() < 40) continue;
    Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
    for (const auto& point_m : cube.points_m) mean_m += point_m;
    mean_m /= static_cast<double>(cube.points_m.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const auto& point_m : cube.points_m) {
      covariance += (point_m - mean_m) * (point_m - mean_m).transpose();
    }
    covariance /= static_cast<double>(cube.points_m.size());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    distances_m.push_back(std::sqrt(std::max(0.0, solver.eigenvalues()(0))));
  }
  EXPECT_GT(distances_m.size(), 50U);
  std::ranges::sort(distances_m);
  return distances_m.empty() ? 0.0 : distances_m[distances_m.size() / 2];
}

TEST(Hdl64RealData, TheLasersAgreeOnTheWallsByTheirCorrections) {
  LANDFIX_REAL_DATA(capture, "hdl64e/s1-at-wall.pcap");
  LANDFIX_REAL_DATA(file, "hdl64e/s1-db.xml");
  const auto packets = test::read_packets(capture, 2368);
  const auto calibration = calibration_of(file);
  const auto unevenness_with = [&](const Hdl64Calibration& changed, const DecoderOptions& options) {
    const Decoded decoded = decode(packets, changed, options);
    return unevenness_m(decoded.sweeps.at(1));
  };
  const double right_m = unevenness_with(calibration, {});

  struct Correction {
    const char* name;
    std::function<void(Hdl64Laser&, double)> scale;
    double worse_without;  ///< by this factor at least
    double worse_flipped;
  };
  const Correction corrections[] = {
      {"rotation", [](Hdl64Laser& laser, double by) { laser.rotation_deg *= by; }, 1.5, 1.5},
      {"elevation", [](Hdl64Laser& laser, double by) { laser.elevation_deg *= by; }, 1.0, 1.0},
      {"range",
       [](Hdl64Laser& laser, double by) {
         laser.range_m *= by;
         laser.range_x_m *= by;
         laser.range_y_m *= by;
       },
       1.5, 1.5},
      {"two-point",
       [](Hdl64Laser& laser, double by) {
         laser.range_x_m = laser.range_m + by * (laser.range_x_m - laser.range_m);
         laser.range_y_m = laser.range_m + by * (laser.range_y_m - laser.range_m);
       },
       1.0, 1.0},
      {"vertical offset", [](Hdl64Laser& laser, double by) { laser.vertical_offset_m *= by; }, 1.0, 1.0},
      {"horizontal offset", [](Hdl64Laser& laser, double by) { laser.horizontal_offset_m *= by; }, 1.0, 1.0},
  };
  std::cout << "unevenness: " << 1e3 * right_m << " mm\n";
  for (const Correction& correction : corrections) {
    const auto with = [&](double by) {
      Hdl64Calibration changed = calibration;
      for (Hdl64Laser& laser : changed.lasers) correction.scale(laser, by);
      return unevenness_with(changed, {});
    };
    const double without_m = with(0.0);
    const double flipped_m = with(-1.0);
    std::cout << correction.name << ": without " << 1e3 * without_m << " mm, flipped " << 1e3 * flipped_m
              << " mm\n";
    EXPECT_GT(without_m, correction.worse_without * right_m) << correction.name;
    EXPECT_GT(flipped_m, correction.worse_flipped * right_m) << correction.name;
  }
  std::cout << "firing times off: " << 1e3 * unevenness_with(calibration, {.firing_time_azimuth = false})
            << " mm\n";
}

}  // namespace
}  // namespace landfix::drivers
