// The LiDAR on the moving vehicle: each laser is cast from where the sensor is when it fires.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ndt/pose.hpp"
#include "tools/simulator/laser_errors.hpp"
#include "tools/simulator/lidar_model.hpp"
#include "tools/simulator/scene.hpp"

namespace landfix::tools::simulator {

/// What the returns of a beam depend on beyond the scene.
struct LidarNoise {
  std::uint64_t seed = 0;
  bool range = true;  ///< the model's
  bool dropouts = true;
  LaserErrors lasers{};
};

/// The echoes of one packet. `sensor_at(time after the packet's moment [s])` gives `map <- sensor`; `cars`
/// are where they are at the packet's moment; `packet` numbers the packets of the drive.
template <class SensorAt>
[[nodiscard]] std::vector<Echo> fire_packet(const Scene& scene, const LidarModel& lidar,
                                            const SensorAt& sensor_at, std::span<const MovingCar> cars,
                                            std::int64_t utc_ns, std::uint64_t packet,
                                            const LidarNoise& noise);

/// What comes back of one shot. `shot` numbers the shots of the drive.
[[nodiscard]] Echo measure(const std::optional<Hit>& hit, const LidarTraits& lidar, std::uint64_t shot,
                           const LidarNoise& noise) noexcept;

template <class SensorAt>
std::vector<Echo> fire_packet(const Scene& scene, const LidarModel& lidar, const SensorAt& sensor_at,
                              std::span<const MovingCar> cars, std::int64_t utc_ns, std::uint64_t packet,
                              const LidarNoise& noise) {
  const LidarTraits& traits = lidar.traits();
  std::vector<Shot> shots(traits.shots_per_packet);
  lidar.aim(utc_ns, shots);
  std::vector<Echo> echoes;
  echoes.reserve(shots.size());
  for (Shot& shot : shots) {
    const LaserError& error = noise.lasers[shot.laser];
    shot.elevation_deg += error.elevation_deg;
    const double after_s = 1e-9 * static_cast<double>(shot.after_ns);
    const ndt::Pose sensor = sensor_at(after_s);
    const Ray ray{.origin_m = sensor * shot.origin_m,
                  .direction = sensor.linear() * shot.direction(),
                  .reach_m = traits.max_range_m};
    std::optional<Hit> hit = scene.cast(ray, cars, after_s);
    if (hit) hit->range_m += error.range_m;
    echoes.push_back(measure(hit, traits, packet * shots.size() + echoes.size(), noise));
  }
  return echoes;
}

}  // namespace landfix::tools::simulator
