// Every sensor of the simulator, there and back: shots are cast into a room, written down by the simulator's
// model, read by the decoder, and the points lie where the shots hit, as exactly as the wire can say it.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/decoder_bench.hpp"
#include "support/lidar_model_probe.hpp"
#include "tools/simulator/lidar.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr std::int64_t kStart_utc_ns = 1'777'882'500'037'000'000;
constexpr std::int64_t kTurns_ns = 350'000'000;  // two sweeps from cut to cut, and what is around them

/// What the sensor can say of a point.
struct Resolution {
  const char* name;
  double range_m;      ///< one unit of the wire
  double azimuth_deg;  ///< half a step of the encoder, and what is left of its jitter in the rate of rotation
  double time_s;       ///< one step of the sensor's clock
};
constexpr Resolution kResolutions[] = {
    {"hdl64s2", 0.002, 0.0075, 1e-6},
    {"hdl64s3", 0.002, 0.0075, 1e-6},
    // One step of its encoder is 0.09 deg. It has no clock.
    {"hdl64s1", 0.002, 0.05, 1e-6},
    // The first packets are timed by the manual's slot, until the unit's is measured.
    {"vls128ap", 0.004, 0.0075, 7e-6},
    {"vls128", 0.004, 0.0075, 7e-6},
    {"hdl32e", 0.002, 0.0075, 1e-6},
    {"vlp32c", 0.004, 0.0075, 1e-6},
    {"vlp16", 0.002, 0.0075, 1e-6},
    {"vlp16hires", 0.002, 0.0075, 1e-6},
    {"pandar64", 0.004, 0.006, 1e-6},
    {"pandar40p", 0.004, 0.006, 1e-6},
    // Columns stand at exact angles, and each has its time in nanoseconds: only floats are between.
    {"os0-32", 0.001, 0.00002, 1e-9},
    {"os0-64", 0.001, 0.00002, 1e-9},
    {"os0-128", 0.008, 0.00002, 1e-9},
    {"os1-16", 0.001, 0.00002, 1e-9},
    {"os1-32", 0.001, 0.00002, 1e-9},
    {"os1-64", 0.001, 0.00002, 1e-9},
    {"os1-128", 0.008, 0.00002, 1e-9},
    {"os2-32", 0.001, 0.00002, 1e-9},
    {"os2-64", 0.001, 0.00002, 1e-9},
    {"os2-128", 0.008, 0.00002, 1e-9},
    {"rs32", 0.005, 0.0075, 1e-6},
    {"rs16", 0.005, 0.0075, 1e-6},
    {"helios16p", 0.0025, 0.0075, 1e-6},
};

const Resolution& resolution_of(std::string_view name) {
  const auto* const found = std::ranges::find(kResolutions, name, &Resolution::name);
  if (found == std::end(kResolutions)) throw std::out_of_range("no resolution of " + std::string(name));
  return *found;
}

/// Where a shot hit, in the sensor's frame.
struct Point {
  double time_s = 0.0;  ///< since kStart_utc_ns
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double range_m = 0.0;
  double elevation_deg = 0.0;
  unsigned intensity = 0;
  unsigned ring = 0;
};

/// A room of 36 m x 50 m x 20 m around the sensor, off the middle.
Mesh room() {
  const Eigen::Vector3d a(-15.0, -20.0, -2.0);
  const Eigen::Vector3d b(21.0, 30.0, 18.0);
  Mesh mesh;
  const auto wall = [&](const std::array<Eigen::Vector3d, 4>& corners, Surface surface) {
    add_quad(mesh, Place::Identity(), corners, surface);
  };
  wall({{{a.x(), a.y(), a.z()}, {b.x(), a.y(), a.z()}, {b.x(), b.y(), a.z()}, {a.x(), b.y(), a.z()}}},
       Surface::asphalt);
  wall({{{a.x(), a.y(), b.z()}, {b.x(), a.y(), b.z()}, {b.x(), b.y(), b.z()}, {a.x(), b.y(), b.z()}}},
       Surface::plaster);
  wall({{{a.x(), a.y(), a.z()}, {b.x(), a.y(), a.z()}, {b.x(), a.y(), b.z()}, {a.x(), a.y(), b.z()}}},
       Surface::plaster);
  wall({{{a.x(), b.y(), a.z()}, {b.x(), b.y(), a.z()}, {b.x(), b.y(), b.z()}, {a.x(), b.y(), b.z()}}},
       Surface::sign);
  wall({{{a.x(), a.y(), a.z()}, {a.x(), b.y(), a.z()}, {a.x(), b.y(), b.z()}, {a.x(), a.y(), b.z()}}},
       Surface::plaster);
  wall({{{b.x(), a.y(), a.z()}, {b.x(), b.y(), a.z()}, {b.x(), b.y(), b.z()}, {b.x(), a.y(), b.z()}}},
       Surface::plaster);
  return mesh;
}

class RoundTrip : public testing::TestWithParam<std::string_view> {
 protected:
  void cast() {
    const Mesh mesh = room();
    const Mesh* const one = &mesh;
    const Scene scene(std::span(&one, 1), {});
    const auto at_rest = [](double) { return ndt::Pose::Identity(); };
    const LidarTraits& traits = lidar_->traits();
    std::vector<Shot> shots(traits.shots_per_packet);
    for (std::size_t i = 0; i * static_cast<std::size_t>(traits.packet_ns) < kTurns_ns; ++i) {
      const std::int64_t utc_ns = kStart_utc_ns + static_cast<std::int64_t>(i) * traits.packet_ns;
      const auto echoes =
          fire_packet(scene, *lidar_, at_rest, {}, utc_ns, i, {.seed = 3, .range = false, .dropouts = false});
      lidar_->aim(utc_ns, shots);
      for (std::size_t j = 0; j < shots.size(); ++j) {
        if (echoes[j].range_m == 0.0) continue;
        const Eigen::Vector3d direction = shots[j].direction();
        cast_.push_back({.time_s = 1e-9 * static_cast<double>(utc_ns + shots[j].after_ns - kStart_utc_ns),
                         .position_m = shots[j].origin_m + echoes[j].range_m * direction,
                         .direction = direction,
                         .range_m = echoes[j].range_m,
                         .elevation_deg = shots[j].elevation_deg,
                         .intensity = echoes[j].reflectivity});
      }
      packets_.push_back(lidar_->encode(i, utc_ns, echoes));
    }
  }

  void decode() {
    const drivers::SensorModel& model = *drivers::find_sensor_model(GetParam());
    test::DecoderBench bench(GetParam(), {}, model.max_points_per_sweep(), test::calibration_of(*lidar_));
    if (lidar_->traits().telemetry_port != 0) {
      const auto result = bench.decode(lidar_->encode_telemetry({.utc_ns = kStart_utc_ns}), kStart_utc_ns);
      EXPECT_EQ(result.status, drivers::DecodeStatus::telemetry) << to_string(result.status);
    }
    std::int64_t receive_utc_ns = kStart_utc_ns;
    for (const auto& payload : packets_) {
      receive_utc_ns += lidar_->traits().packet_ns;
      const auto result = bench.decode(payload, receive_utc_ns);
      ASSERT_EQ(result.status, drivers::DecodeStatus::decoded) << to_string(result.status);
    }
    static_cast<void>(bench.flush());
    EXPECT_EQ(bench.counters().lost_packets, 0U);
    for (const auto& sweep : bench.swept()) {
      complete_.push_back(sweep.complete);
      EXPECT_EQ(sweep.overflowed, 0U);
      for (const drivers::Point& point : sweep.points) {
        decoded_.push_back({.time_s = 1e-9 * static_cast<double>(sweep.start_utc_ns - kStart_utc_ns) +
                                      static_cast<double>(point.time_s),
                            .position_m = Eigen::Vector3f(point.x, point.y, point.z).cast<double>(),
                            .intensity = static_cast<unsigned>(point.intensity),
                            .ring = point.ring});
      }
    }
  }

  std::unique_ptr<LidarModel> lidar_ = make_lidar_model(GetParam());
  std::vector<std::vector<std::byte>> packets_;
  std::vector<Point> cast_;
  std::vector<Point> decoded_;
  std::vector<bool> complete_;
};

TEST_P(RoundTrip, ReproducesWhereTheShotsHit) {
  cast();
  decode();
  EXPECT_EQ(complete_, (std::vector<bool>{false, true, true, false}));
  ASSERT_GT(cast_.size(), packets_.size() * lidar_->traits().shots_per_packet / 2);
  ASSERT_EQ(decoded_.size(), cast_.size());
  const Resolution& resolution = resolution_of(GetParam());
  std::map<unsigned, double> elevation_of_ring_deg;
  double most_along_m = 0.0;
  double most_across_deg = 0.0;
  double most_late_s = 0.0;
  for (std::size_t i = 0; i < cast_.size(); ++i) {
    const Eigen::Vector3d error_m = decoded_[i].position_m - cast_[i].position_m;
    const double along_m = error_m.dot(cast_[i].direction);
    const double across_m = (error_m - along_m * cast_[i].direction).norm();
    most_along_m = std::max(most_along_m, std::abs(along_m));
    most_across_deg =
        std::max(most_across_deg, across_m / std::max(cast_[i].range_m, 1.0) * 180.0 / std::numbers::pi);
    most_late_s = std::max(most_late_s, std::abs(decoded_[i].time_s - cast_[i].time_s));
    ASSERT_EQ(decoded_[i].intensity, cast_[i].intensity) << i;
    const auto [known, is_new] = elevation_of_ring_deg.try_emplace(decoded_[i].ring, cast_[i].elevation_deg);
    ASSERT_DOUBLE_EQ(known->second, cast_[i].elevation_deg) << "ring " << decoded_[i].ring;
  }
  EXPECT_LT(most_along_m, 0.5 * resolution.range_m + 1e-4);
  EXPECT_LT(most_across_deg, resolution.azimuth_deg);
  EXPECT_LT(most_late_s, resolution.time_s + 2e-8);
  double below_deg = -90.0;
  for (const auto& [ring, elevation_deg] : elevation_of_ring_deg) {
    EXPECT_GT(elevation_deg, below_deg) << "ring " << ring;
    below_deg = elevation_deg;
  }
  std::cout << GetParam() << ": " << cast_.size() << " points, most along the beam " << 1e3 * most_along_m
            << " mm, across " << most_across_deg << " deg, time " << 1e6 * most_late_s << " us\n";
}

TEST(RoundTripGate, IsForEverySensorOfTheCatalogue) {
  std::vector<std::string_view> catalogue;
  for (const drivers::SensorModel& model : drivers::sensor_models()) catalogue.push_back(model.name);
  EXPECT_EQ(lidar_model_names(), catalogue);
}

INSTANTIATE_TEST_SUITE_P(EverySensor, RoundTrip, testing::ValuesIn(lidar_model_names()),
                         [](const auto& sensor) {
                           std::string name(sensor.param);
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace landfix::tools::simulator
