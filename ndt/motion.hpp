// The vehicle's motion between and within sweeps: constant velocity over a sweep, and points brought to its
// end.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "drivers/point.hpp"
#include "ndt/pose.hpp"

namespace landfix::ndt {

/// Twist a second, frame `vehicle`: [m/s], [rad/s].
using Velocity = Twist;

/// The constant velocity that leads from one pose to a later one.
[[nodiscard]] Velocity velocity_between(const StampedPose& from, const StampedPose& to) noexcept;

/// Where a constant velocity leads.
[[nodiscard]] Pose predict(const StampedPose& from, const Velocity& velocity,
                           std::int64_t stamp_utc_ns) noexcept;

/// Undoes the sweep's motion distortion: a point seen at its firing time, from where the sensor was then, as
/// it would be seen from the vehicle at the end of the sweep.
class Deskew {
 public:
  /// `duration_s`: time of the sweep's last point. `sensor_pose`: vehicle <- sensor.
  Deskew(const Velocity& velocity, float duration_s, const Pose& sensor_pose) noexcept;

  /// Frame `vehicle` at the end of the sweep [m].
  [[nodiscard]] Eigen::Vector3f operator()(const drivers::Point& point) const noexcept;

 private:
  // The motion is tabulated and interpolated: over 1/64 of a turn, even at 1 rad/s and 100 m, the chord is
  // within 0.1 mm of the arc.
  static constexpr std::size_t kSteps = 64;

  using Transform = Eigen::Matrix<float, 3, 4>;  // vehicle at the end <- sensor at the step
  std::array<Transform, kSteps + 1> steps_;
  float steps_per_s_ = 0.0F;
};

}  // namespace landfix::ndt
