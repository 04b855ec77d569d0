#include "tools/simulator/lidar.hpp"

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace landfix::tools::simulator {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;
constexpr LidarNoise kNoNoise{.seed = 1, .range = false, .dropouts = false};
const std::unique_ptr<LidarModel> kVlp16 = make_lidar_model("vlp16");

/// A wall across x at `x_m`, as wide and as high as one could wish.
Mesh wall_at(double x_m) {
  Mesh mesh;
  add_quad(mesh, Place::Identity(),
           {{{x_m, -300, -300}, {x_m, 300, -300}, {x_m, 300, 300}, {x_m, -300, 300}}}, Surface::plaster);
  return mesh;
}

Scene scene_of(const Mesh& mesh) {
  const Mesh* const one = &mesh;
  return {std::span(&one, 1), {}};
}

TEST(Lidar, MeasuresAWallExactlyFromAMovingAndTurningSensor) {
  const Scene scene = scene_of(wall_at(40.0));
  const Eigen::Vector3d velocity_mps(20.0, -3.0, 0.5);
  constexpr double kYawRate_radps = 0.8;
  constexpr double kPitch_rad = 0.03;
  const auto sensor_at = [&](double t_s) {
    return ndt::make_pose(Eigen::Vector3d(1.0, 2.0, 3.0) + t_s * velocity_mps,
                          {.pitch_rad = kPitch_rad, .yaw_rad = 0.2 + kYawRate_radps * t_s});
  };
  // Six packets, from ahead on, in all 8 ms: the sensor moves 16 cm and turns 0.4 deg.
  std::size_t compared = 0;
  for (int packet = 0; packet < 6; ++packet) {
    const std::int64_t packet_ns = packet * 1'327'104;
    const auto sensor_from_here = [&](double after_s) {
      return sensor_at(after_s + 1e-9 * static_cast<double>(packet_ns));
    };
    const std::int64_t stamp_ns = 1'777'882'500'000'000'000 + packet_ns;
    const std::vector<Echo> echoes = fire_packet(scene, *kVlp16, sensor_from_here, {}, stamp_ns, 0, kNoNoise);
    for (std::size_t i = 0; i < 384; ++i) {
      // The manual's arithmetic, written out once more.
      const std::size_t laser = i % 16;
      const double t_s =
          1e-9 * static_cast<double>(packet_ns) +
          1e-6 * (110.592 * static_cast<double>(i / 32) + 55.296 * static_cast<double>(i % 32 / 16) +
                  2.304 * static_cast<double>(laser));
      const double azimuth_rad = 3600.0 * t_s * kDegree_rad;
      const double elevation_rad =
          kDegree_rad * (laser % 2 == 0 ? -15.0 + static_cast<double>(laser) : static_cast<double>(laser));
      const Eigen::AngleAxisd yaw(0.2 + kYawRate_radps * t_s, Eigen::Vector3d::UnitZ());
      const Eigen::AngleAxisd pitch(kPitch_rad, Eigen::Vector3d::UnitY());
      const Eigen::Vector3d beam =
          yaw * pitch *
          Eigen::Vector3d(std::cos(elevation_rad) * std::cos(azimuth_rad),
                          -std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
      const Eigen::Vector3d rise_m = yaw * pitch * Eigen::Vector3d(0, 0, -0.0418 * std::tan(elevation_rad));
      const double origin_x_m = 1.0 + 20.0 * t_s + rise_m.x();
      const double range_m = (40.0 - origin_x_m) / beam.x();
      ASSERT_NEAR(echoes[i].range_m, range_m, 2e-4) << packet << ' ' << i;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 6U * 384U);
}

TEST(Lidar, SeesAMovingCarWhereItIsWhenTheLaserFires) {
  const Mesh far_wall = wall_at(90.0);
  const Mesh box = wall_at(0.0);  // a "car" that is one wall through its origin
  const Mesh* const one = &far_wall;
  const Scene scene(std::span(&one, 1), std::span(&box, 1));
  MovingCar car;
  car.place.translation() = Eigen::Vector3d(30.0, 0.0, 0.0);
  car.velocity_mps = Eigen::Vector3d(-15.0, 0.0, 0.0);
  const Ray ray{.origin_m = {0, 0, 1}, .direction = {1, 0, 0}, .reach_m = 100.0};
  for (const double later_s : {0.0, 0.001, 0.1}) {
    const std::optional<Hit> hit = scene.cast(ray, std::span(&car, 1), later_s);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->range_m, 30.0 - 15.0 * later_s, 1e-4);
  }
  EXPECT_NEAR(scene.cast(ray, {}, 0.0)->range_m, 90.0, 1e-4);
}

TEST(Lidar, TheSkyDoesNotAnswer) {
  const Scene scene = scene_of(wall_at(40.0));
  EXPECT_FALSE(scene.cast({.origin_m = {0, 0, 0}, .direction = {-1, 0, 0}, .reach_m = 100.0}, {}, 0.0));
  EXPECT_FALSE(scene.cast({.origin_m = {0, 0, 0}, .direction = {1, 0, 0}, .reach_m = 39.9}, {}, 0.0));
  EXPECT_EQ(measure(std::nullopt, kVlp16->traits(), 0, kNoNoise).range_m, 0.0);
}

TEST(Lidar, RangeNoiseIsThatOfTheDataSheet) {
  const Hit hit{.range_m = 20.0, .cos_incidence = 1.0, .reflectivity = 0.5};
  double sum_m = 0.0;
  double squares_m2 = 0.0;
  constexpr int kCount = 20000;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const double error_m = measure(hit, kVlp16->traits(), i, {.seed = 4, .dropouts = false}).range_m - 20.0;
    sum_m += error_m;
    squares_m2 += error_m * error_m;
  }
  EXPECT_NEAR(sum_m / kCount, 0.0, 3e-4);
  EXPECT_NEAR(std::sqrt(squares_m2 / kCount), 0.01, 3e-4);
}

double answered(const Hit& hit) {
  int count = 0;
  for (std::uint64_t i = 0; i < 4000; ++i)
    count += measure(hit, kVlp16->traits(), i, {.seed = 9}).range_m > 0.0;
  return count / 4000.0;
}

TEST(Lidar, FarDarkAndGrazedSurfacesAnswerLessOften) {
  EXPECT_GT(answered({.range_m = 20.0, .cos_incidence = 1.0, .reflectivity = 0.5}), 0.99);
  EXPECT_GT(answered({.range_m = 60.0, .cos_incidence = 1.0, .reflectivity = 0.5}),
            answered({.range_m = 95.0, .cos_incidence = 1.0, .reflectivity = 0.5}));
  EXPECT_GT(answered({.range_m = 60.0, .cos_incidence = 1.0, .reflectivity = 0.5}),
            answered({.range_m = 60.0, .cos_incidence = 1.0, .reflectivity = 0.05}) + 0.2);
  EXPECT_GT(answered({.range_m = 40.0, .cos_incidence = 1.0, .reflectivity = 0.15}),
            answered({.range_m = 40.0, .cos_incidence = 0.05, .reflectivity = 0.15}) + 0.2);
}

TEST(Lidar, OnlyRetroReflectorsExceedAHundredPercent) {
  const Hit paper{.range_m = 10.0, .cos_incidence = 1.0, .reflectivity = reflectivity(Surface::plaster)};
  const Hit sign{.range_m = 10.0, .cos_incidence = 1.0, .reflectivity = reflectivity(Surface::sign)};
  for (std::uint64_t i = 0; i < 1000; ++i) {
    ASSERT_LE(measure(paper, kVlp16->traits(), i, kNoNoise).reflectivity, 100);
    ASSERT_GT(measure(sign, kVlp16->traits(), i, kNoNoise).reflectivity, 100);
  }
}

TEST(Lidar, StaysWithinTheSensorsRange) {
  for (const double range_m : {0.2, 0.4, 99.999, 100.5}) {
    const Hit hit{.range_m = range_m, .cos_incidence = 1.0, .reflectivity = 1.0};
    for (std::uint64_t i = 0; i < 100; ++i) {
      const double measured_m = measure(hit, kVlp16->traits(), i, {.seed = 2, .dropouts = false}).range_m;
      EXPECT_TRUE(measured_m == 0.0 || (measured_m >= 0.5 && measured_m <= 100.0)) << measured_m;
    }
  }
}

TEST(Lidar, ALaserOfAUnitPointsAndMeasuresAsWrongAsItsErrorSays) {
  const Scene scene = scene_of(wall_at(40.0));
  const auto at_rest = [](double /*after_s*/) { return ndt::Pose(ndt::Pose::Identity()); };
  LidarNoise noise = kNoNoise;
  noise.lasers[3] = {.elevation_deg = 0.5, .range_m = -0.25};
  const std::int64_t ahead_ns = 1'777'882'500'000'000'000;
  const auto right = fire_packet(scene, *kVlp16, at_rest, {}, ahead_ns, 0, kNoNoise);
  const auto wrong = fire_packet(scene, *kVlp16, at_rest, {}, ahead_ns, 0, noise);
  // Laser 3 points 3 deg up.
  const double longer = std::cos(3.0 * kDegree_rad) / std::cos(3.5 * kDegree_rad);
  for (std::size_t i = 0; i < right.size(); ++i) {
    const double expected_m = i % 16 == 3 ? right[i].range_m * longer - 0.25 : right[i].range_m;
    ASSERT_NEAR(wrong[i].range_m, expected_m, 2e-4) << i;
  }
}

TEST(Lidar, EveryLaserOfEverySensorHasItsOwnNumber) {
  for (const std::string_view name : lidar_model_names()) {
    const auto lidar = make_lidar_model(name);
    std::vector<Shot> shots(lidar->traits().shots_per_packet);
    lidar->aim(1'777'882'500'000'000'000, shots);
    std::map<std::size_t, double> elevations_deg;
    for (const Shot& shot : shots) {
      ASSERT_LT(shot.laser, kMostLasers) << name;
      const auto [known, is_new] = elevations_deg.emplace(shot.laser, shot.elevation_deg);
      ASSERT_EQ(known->second, shot.elevation_deg) << name << ", laser " << shot.laser;
    }
    EXPECT_EQ(shots.size() % elevations_deg.size(), 0) << name;
    EXPECT_GE(elevations_deg.size(), 16) << name;
  }
}

TEST(Lidar, UnitsDifferAsMuchAsTheTraitsSayAndTheIdealOneDoesNot) {
  const LidarTraits& traits = kVlp16->traits();
  for (const LaserError& error : laser_errors(traits, 0)) {
    EXPECT_EQ(error.elevation_deg, 0.0);
    EXPECT_EQ(error.range_m, 0.0);
  }
  double elevations = 0.0;
  double ranges = 0.0;
  constexpr int kUnits = 50;
  for (int unit = 1; unit <= kUnits; ++unit) {
    for (const LaserError& error : laser_errors(traits, static_cast<std::uint64_t>(unit))) {
      elevations += std::pow(error.elevation_deg / traits.elevation_sigma_deg, 2);
      ranges += std::pow(error.range_m / traits.range_sigma_m, 2);
    }
  }
  constexpr double kLasers = kUnits * static_cast<double>(kMostLasers);
  EXPECT_NEAR(elevations / kLasers, 1.0, 0.1);
  EXPECT_NEAR(ranges / kLasers, 1.0, 0.1);
  EXPECT_NE(laser_errors(traits, 1)[0].range_m, laser_errors(traits, 2)[0].range_m);
}

}  // namespace
}  // namespace landfix::tools::simulator
