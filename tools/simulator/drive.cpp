#include "tools/simulator/drive.hpp"

#include <array>
#include <utility>

#include "tools/simulator/car_model.hpp"
#include "tools/simulator/traffic.hpp"

namespace landfix::tools::simulator {
namespace {

Scene make_scene(const World& world) {
  const std::array<const Mesh*, 2> standing{&world.surveyed, &world.parked};
  return {standing, car_models()};
}

}  // namespace

ndt::Pose SensorMounting::pose() const noexcept {
  return ndt::make_pose(position_m, {.roll_rad = ndt::kRadians_per_deg * roll_deg,
                                     .pitch_rad = ndt::kRadians_per_deg * pitch_deg,
                                     .yaw_rad = ndt::kRadians_per_deg * yaw_deg});
}

Drive::Drive(Route route, std::uint64_t seed, std::string_view sensor, std::uint64_t unit)
    : lidar_(make_lidar_model(sensor)),
      unit_(unit),
      laser_errors_(laser_errors(lidar_->traits(), unit)),
      route_(std::move(route)),
      seed_(seed),
      path_(route_),
      ground_(path_, route_, plan_side_streets(route_, path_, seed), seed),
      world_(build_world(route_, ground_, seed)),
      vehicle_(route_, ground_),
      scene_(make_scene(world_)) {}

std::size_t Drive::packets() const noexcept {
  return static_cast<std::size_t>(vehicle_.duration_s() * 1e9 /
                                  static_cast<double>(lidar_->traits().packet_ns));
}

std::int64_t Drive::packet_utc_ns(std::size_t packet) const noexcept {
  return kDriveStart_utc_ns + static_cast<std::int64_t>(packet) * lidar_->traits().packet_ns;
}

/// `vehicle_at(time since the start of the drive [s])` gives map <- vehicle.
template <class VehicleAt>
std::vector<Echo> Drive::fire(std::size_t packet, const VehicleAt& vehicle_at) const {
  constexpr double kLongestCar_m = 6.0;
  const std::int64_t utc_ns = packet_utc_ns(packet);
  const double start_s = 1e-9 * static_cast<double>(utc_ns - kDriveStart_utc_ns);
  const std::vector<MovingCar> cars = cars_near_vehicle(world_.traffic, ground_, vehicle_, start_s,
                                                        lidar_->traits().max_range_m + kLongestCar_m);
  const ndt::Pose mounting = kSensorMounting.pose();
  const auto sensor_at = [&](double after_s) -> ndt::Pose {
    return vehicle_at(start_s + after_s) * mounting;
  };
  return fire_packet(scene_, *lidar_, sensor_at, cars, utc_ns, packet,
                     {.seed = seed_, .lasers = laser_errors_});
}

std::vector<Echo> Drive::fire(std::size_t packet) const {
  return fire(packet, [this](double time_s) { return vehicle_.pose_at(time_s); });
}

std::vector<Echo> Drive::fire_from(std::size_t packet, const ndt::Pose& vehicle) const {
  return fire(packet, [&vehicle](double /*time_s*/) { return vehicle; });
}

}  // namespace landfix::tools::simulator
