// A drive: a route, its world, the vehicle's way through it and what its LiDAR measures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "ndt/pose.hpp"
#include "tools/simulator/ground.hpp"
#include "tools/simulator/lidar.hpp"
#include "tools/simulator/route.hpp"
#include "tools/simulator/scene.hpp"
#include "tools/simulator/vehicle_motion.hpp"
#include "tools/simulator/world.hpp"

namespace landfix::tools::simulator {

/// A route with its world, the vehicle's way through it and its sensor. The same route, seed and sensor give
/// the same drive.
class Drive {
 public:
  /// `sensor`: see make_lidar_model, whose errors these are too; `unit`: of it, see laser_errors.
  Drive(Route route, std::uint64_t seed, std::string_view sensor = "vlp16", std::uint64_t unit = 0);
  Drive(const Drive&) = delete;
  Drive& operator=(const Drive&) = delete;
  ~Drive() = default;

  [[nodiscard]] const Route& route() const noexcept { return route_; }
  [[nodiscard]] std::uint64_t seed() const noexcept { return seed_; }
  [[nodiscard]] std::uint64_t unit() const noexcept { return unit_; }
  [[nodiscard]] const Ground& ground() const noexcept { return ground_; }
  [[nodiscard]] const World& world() const noexcept { return world_; }
  /// The standing world, as light meets it.
  [[nodiscard]] const Scene& scene() const noexcept { return scene_; }
  [[nodiscard]] const VehicleMotion& vehicle() const noexcept { return vehicle_; }
  [[nodiscard]] const LidarModel& lidar() const noexcept { return *lidar_; }

  [[nodiscard]] std::size_t packets() const noexcept;
  /// The moment of a packet, Unix nanoseconds UTC.
  [[nodiscard]] std::int64_t packet_utc_ns(std::size_t packet) const noexcept;
  /// Whole packets from the start of the drive on; thread-safe.
  [[nodiscard]] std::vector<Echo> fire(std::size_t packet) const;
  /// As if the vehicle stood at `vehicle` (map <- vehicle) meanwhile.
  [[nodiscard]] std::vector<Echo> fire_from(std::size_t packet, const ndt::Pose& vehicle) const;

 private:
  template <class VehicleAt>
  [[nodiscard]] std::vector<Echo> fire(std::size_t packet, const VehicleAt& vehicle_at) const;

  std::unique_ptr<LidarModel> lidar_;
  std::uint64_t unit_;
  LaserErrors laser_errors_;
  Route route_;
  std::uint64_t seed_;
  Path path_;
  Ground ground_;
  World world_;
  VehicleMotion vehicle_;
  Scene scene_;
};

/// `vehicle <- sensor`: on the roof, not quite level, as sensors are.
struct SensorMounting {
  Eigen::Vector3d position_m{1.2, 0.0, 1.9};
  double roll_deg = 0.0;
  double pitch_deg = 1.0;
  double yaw_deg = -0.5;

  [[nodiscard]] ndt::Pose pose() const noexcept;
};
inline const SensorMounting kSensorMounting;

/// The moment of the drive's first packet, Unix nanoseconds UTC: 2026-05-04 08:15:00.037.
inline constexpr std::int64_t kDriveStart_utc_ns = 1'777'882'500'037'000'000;

}  // namespace landfix::tools::simulator
