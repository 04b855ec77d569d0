// The LiDAR on the moving vehicle: each laser is cast from where the sensor is when it fires.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ndt/pose.hpp"
#include "tools/simulator/scene.hpp"
#include "tools/simulator/velodyne_encoder.hpp"

namespace landfix::tools::simulator {

/// What the returns of a beam depend on beyond the scene.
struct LidarNoise {
  std::uint64_t seed = 0;
  double range_sigma_m = vlp16::kRangeNoise_m;
  bool dropouts = true;
};

/// One packet's worth of firings. `sensor_at(time after the packet's first firing [s])` gives `map <-
/// sensor`; `cars` are where they are at the packet's first firing; `packet` numbers the packets of the
/// drive.
template <class SensorAt>
[[nodiscard]] Vlp16Firings fire_packet(const Scene& scene, const SensorAt& sensor_at,
                                       std::span<const MovingCar> cars, std::int64_t first_firing_utc_ns,
                                       std::uint64_t packet, const LidarNoise& noise);

/// The return of one firing; distance 0 if there is none. `firing` numbers the firings of the drive.
[[nodiscard]] Vlp16Return measure(const std::optional<Hit>& hit, std::uint64_t firing,
                                  const LidarNoise& noise) noexcept;

template <class SensorAt>
Vlp16Firings fire_packet(const Scene& scene, const SensorAt& sensor_at, std::span<const MovingCar> cars,
                         std::int64_t first_firing_utc_ns, std::uint64_t packet, const LidarNoise& noise) {
  Vlp16Firings firings{.first_firing_utc_ns = first_firing_utc_ns};
  for (std::size_t i = 0; i < vlp16::kFiringsPerPacket; ++i) {
    const std::int64_t after_ns = vlp16::firing_time_ns(i);
    const double after_s = 1e-9 * static_cast<double>(after_ns);
    const double azimuth_deg = vlp16::rotor_angle_deg(first_firing_utc_ns + after_ns);
    const std::size_t block = i / vlp16::kFiringsPerBlock;
    if (i % vlp16::kFiringsPerBlock == 0) {
      firings.azimuth_centideg_raw[block] =
          static_cast<std::uint16_t>(std::lround(100.0 * azimuth_deg) % 36000);
    }
    const vlp16::Beam& beam = vlp16::kBeams[i % vlp16::kLasers];
    const ndt::Pose sensor = sensor_at(after_s);
    const Ray ray{.origin_m = sensor * vlp16::beam_origin_m(beam),
                  .direction = sensor.linear() * vlp16::beam_direction(beam, azimuth_deg),
                  .reach_m = vlp16::kMaxRange_m};
    firings.returns[i] =
        measure(scene.cast(ray, cars, after_s), packet * vlp16::kFiringsPerPacket + i, noise);
  }
  return firings;
}

}  // namespace landfix::tools::simulator
