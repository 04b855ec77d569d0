// The recorded packets of an HDL-64E S1 against the cloud of the vendor's viewer, and its calibration against
// the walls that it saw.
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <gtest/gtest.h>

#include "drivers/velodyne/hdl64_calibration_file.hpp"
#include "drivers/velodyne/hdl64_wire.hpp"
#include "real/cloud_comparison.hpp"
#include "support/test_data.hpp"

namespace landfix::drivers {
namespace {

using velodyne::Hdl64Calibration;
using velodyne::Hdl64Laser;

Hdl64Calibration calibration_of(const std::filesystem::path& path) {
  return velodyne::parse_hdl64_calibration(platform::read_file(path), path.string());
}

struct Apart {
  double median_m = 0.0;
  double most_m = 0.0;
};

Apart apart(std::span<const Point> ours, std::span<const Point> theirs) {
  std::vector<double> distances_m;
  for (std::size_t i = 0; i < std::min(ours.size(), theirs.size()); ++i) {
    const float distance_m =
        std::hypot(ours[i].x - theirs[i].x, ours[i].y - theirs[i].y, ours[i].z - theirs[i].z);
    distances_m.push_back(static_cast<double>(distance_m));
  }
  std::ranges::sort(distances_m);
  return {distances_m.at(distances_m.size() / 2), distances_m.back()};
}

TEST(Hdl64RealData, ReproducesTheVendorsViewer) {
  LANDFIX_REAL_DATA(capture, "hdl64e/s1-at-wall.pcap");
  LANDFIX_REAL_DATA(file, "hdl64e/s1-db.xml");
  LANDFIX_REAL_DATA(reference, "hdl64e/s1-at-wall-sweep.csv");
  const auto packets = test::read_packets(capture, 2368);
  EXPECT_EQ(packets.size(), 306U);
  const auto calibration = calibration_of(file);
  const auto theirs = test::read_viewer_csv(reference);
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
      {"neither", {.firing_time_azimuth = false, .two_point_correction = false}, 0.0, 3e-6, 4e-5},
      // the corrections of this unit differ near and far by up to 11 cm,
      {"two-point", {.firing_time_azimuth = false}, 0.01, 0.03, 0.15},
      // and its rotor turns 0.11 deg while a block fires.
      {"firing times", {.two_point_correction = false}, 1e-3, 0.03, 0.25},
  };
  for (const Case& a_case : cases) {
    const auto sweeps = test::decode_sweeps("hdl64s1", packets, a_case.options, calibration);
    ASSERT_GE(sweeps.size(), 2U);
    const auto& ours = sweeps[1].points;
    ASSERT_EQ(ours.size(), theirs.size());
    for (std::size_t i = 0; i < ours.size(); ++i) ASSERT_EQ(ours[i].intensity, theirs[i].intensity);
    const Apart result = apart(ours, theirs);
    std::cout << a_case.name << ": median " << result.median_m << " m, most " << result.most_m << " m\n";
    EXPECT_GE(result.median_m, a_case.least_median_m) << a_case.name;
    EXPECT_LT(result.median_m, a_case.median_m) << a_case.name;
    EXPECT_LT(result.most_m, a_case.most_m) << a_case.name;
  }
}

TEST(Hdl64RealData, TheEncoderHas4000Steps) {
  LANDFIX_REAL_DATA(capture, "hdl64e/s1-at-wall.pcap");
  for (const auto& packet : test::read_packets(capture, 2368)) {
    for (std::size_t block = 0; block < velodyne::kBlocks; ++block) {
      ASSERT_EQ(velodyne::hdl64_azimuth(packet.payload, block) % 9, 0);
    }
  }
}

/// A flat part of the scene: where the turned beams of some neighbouring lasers meet it.
struct Surface {
  const char* name;
  double from_deg;  ///< clockwise
  double to_deg;
  std::uint16_t first_ring;
  std::uint16_t last_ring;
  int normal;  ///< axis that it is more or less square to
};
constexpr Surface kWall{"wall", -30.0, 35.0, 50, 62, 0};  // 18 m ahead, seen by the upper block
constexpr double kCellDeg = 5.0;

/// What is left of the surface's points by laser and sector: distances from a plane.
using Cells = std::map<std::pair<std::uint16_t, int>, std::vector<double>>;

Cells cells_of(std::span<const Point> points, const Surface& surface) {
  std::vector<Eigen::Vector3d> chosen_m;
  std::vector<std::pair<std::uint16_t, int>> cell;
  for (const Point& point : points) {
    if (point.ring < surface.first_ring || point.ring > surface.last_ring) continue;
    const Eigen::Vector3d position_m = Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
    const double azimuth_deg = -std::atan2(position_m.y(), position_m.x()) * 180.0 / std::numbers::pi;
    const double from_start_deg = std::fmod(azimuth_deg - surface.from_deg + 720.0, 360.0);
    if (from_start_deg > surface.to_deg - surface.from_deg || position_m.head<2>().norm() < 3.0) continue;
    chosen_m.push_back(position_m);
    cell.emplace_back(point.ring, static_cast<int>(from_start_deg / kCellDeg));
  }
  // normal coordinate = plane . (1, the two others); what is far from it is something else.
  const int n = surface.normal;
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  const auto row = [n](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(1.0, p((n + 1) % 3), p((n + 2) % 3));
  };
  double most_m = 1e9;
  for (int round = 0; round < 6; ++round) {
    Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : chosen_m) {
      if (std::abs(p(n) - plane.dot(row(p))) > most_m) continue;
      left += row(p) * row(p).transpose();
      right += row(p) * p(n);
    }
    plane = left.ldlt().solve(right);
    most_m = round < 2 ? 3.0 : 1.5;
  }
  Cells cells;
  for (std::size_t i = 0; i < chosen_m.size(); ++i) {
    cells[cell[i]].push_back(chosen_m[i](n) - plane.dot(row(chosen_m[i])));
  }
  return cells;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values.empty() ? 0.0 : values[values.size() / 2];
}

/// By how much neighbouring lasers disagree about where the surface is: the median over sectors and pairs.
double disagreement_m(std::span<const Point> points, const Surface& surface) {
  std::vector<double> steps_m;
  const Cells cells = cells_of(points, surface);
  for (const auto& [place, distances_m] : cells) {
    const auto above = cells.find({static_cast<std::uint16_t>(place.first + 1), place.second});
    if (above == cells.end() || distances_m.size() < 5 || above->second.size() < 5) continue;
    steps_m.push_back(std::abs(median(above->second) - median(distances_m)));
  }
  EXPECT_GT(steps_m.size(), 50U) << surface.name;
  return median(steps_m);
}

/// The file's differences between the ranges of its lasers are not this unit's: wall and ground say that its
/// lasers need corrections within a few centimetres of each other, those of the file spread over half a
/// metre and have nothing to do with them. So the range corrections cannot be checked here; their mean
/// serves.
Hdl64Calibration with_mean_ranges(Hdl64Calibration calibration) {
  double sum_m = 0.0;
  for (const Hdl64Laser& laser : calibration.lasers) sum_m += laser.range_m;
  for (Hdl64Laser& laser : calibration.lasers) {
    laser.range_m = laser.range_x_m = laser.range_y_m = sum_m / static_cast<double>(velodyne::kHdl64Lasers);
  }
  return calibration;
}

TEST(Hdl64RealData, TheCorrectionsMakeTheLasersSeeTheSameSurfaces) {
  LANDFIX_REAL_DATA(capture, "hdl64e/s1-at-wall.pcap");
  LANDFIX_REAL_DATA(file, "hdl64e/s1-db.xml");
  const auto packets = test::read_packets(capture, 2368);
  const auto calibration = with_mean_ranges(calibration_of(file));
  struct Correction {
    const char* name;
    std::function<void(Hdl64Laser&, double)> scale;
    std::function<double(std::span<const Point>)> error_m;
    double worse_without;  ///< by this factor at least
    double worse_flipped;
  };
  const auto on_the_wall = [](std::span<const Point> points) { return disagreement_m(points, kWall); };
  const Correction corrections[] = {
      {"rotation", [](Hdl64Laser& laser, double by) { laser.rotation_deg *= by; }, on_the_wall, 3.0, 6.0},
      {"horizontal offset", [](Hdl64Laser& laser, double by) { laser.horizontal_offset_m *= by; },
       on_the_wall, 1.02, 1.1},
  };
  for (const Correction& correction : corrections) {
    const auto error_m = [&](double by) {
      Hdl64Calibration changed = calibration;
      for (Hdl64Laser& laser : changed.lasers) correction.scale(laser, by);
      return correction.error_m(test::decode_sweeps("hdl64s1", packets, {}, changed).at(1).points);
    };
    const double right_m = error_m(1.0);
    const double without_m = error_m(0.0);
    const double flipped_m = error_m(-1.0);
    std::cout << correction.name << ": right " << 1e3 * right_m << " mm, without " << 1e3 * without_m
              << " mm, flipped " << 1e3 * flipped_m << " mm\n";
    EXPECT_GT(without_m, correction.worse_without * right_m) << correction.name;
    EXPECT_GT(flipped_m, correction.worse_flipped * right_m) << correction.name;
  }
}

}  // namespace
}  // namespace landfix::drivers
