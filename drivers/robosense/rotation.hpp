// How far the rotor turns from firing to firing: from the azimuths of a packet, and over the time between
// packets.
#pragma once

#include <cstdint>
#include <span>

namespace landfix::drivers::robosense {

/// More from one block to the next is a gap: the sensor is silent outside its field of view.
inline constexpr int kWidestStepCentideg = 100;

/// Mean of the steps that are no gaps, which averages the encoder's jitter out; 0 where there is none.
[[nodiscard]] double mean_step_centideg(std::span<const std::uint16_t> azimuths_centideg) noexcept;

/// The speed of rotation without knowing the period of firings.
class RotorSpeed {
 public:
  /// As set at the sensor; 0: not known. Holds until packets tell better.
  void set_nominal(unsigned motor_rpm) noexcept;
  /// Takes the first azimuth of each packet and its time by the sensor's clock.
  void update(std::uint16_t azimuth_centideg, std::int64_t sensor_ns) noexcept;

  [[nodiscard]] double centideg_per_us() const noexcept { return centideg_per_us_; }

 private:
  double centideg_per_us_ = 0.36;  ///< 600 rpm
  std::int64_t last_ns_ = 0;
  std::uint16_t last_azimuth_centideg_ = 0;
  bool started_ = false;
  bool measured_ = false;
};

}  // namespace landfix::drivers::robosense
