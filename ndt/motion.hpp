// The vehicle's motion between and within sweeps: constant velocity over a sweep, and points brought to one
// time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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

/// What of a road vehicle's velocity lasts from one sweep to the next: it drives, slips sideways and turns.
/// Heave, roll and pitch swing on the springs, several times a second: what they did a sweep ago is not what
/// they do now, and to undo it adds error (on the simulated routes it doubles that of roll and pitch).
[[nodiscard]] Velocity steady_part(const Velocity& velocity) noexcept;

/// Where a constant velocity leads.
[[nodiscard]] Pose predict(const StampedPose& from, const Velocity& velocity,
                           std::int64_t stamp_utc_ns) noexcept;

/// Undoes a sweep's motion distortion point by point, as the points come: when the sweep will end is not
/// known yet, so they are brought to its start, and what is left of them to its end by one rigid motion.
class Deskew {
 public:
  /// `velocity`: constant over the sweep. `sensor_pose`: vehicle <- sensor.
  void begin(std::int64_t start_utc_ns, const Velocity& velocity, const Pose& sensor_pose) noexcept;

  /// A point seen at its firing time, from where the sensor was then, as it would be seen from the vehicle at
  /// the start [m]. `late_s`: how much later than the start the point's own sweep began; a firing that was
  /// overtaken moves a sweep's start.
  [[nodiscard]] Eigen::Vector3f to_start(const drivers::Point& point, float late_s) const noexcept {
    // A time that is not a number counts as the start.
    const float place = (point.time_s + late_s) * kSteps_per_s;
    const float step = std::min(std::max(0.0F, std::floor(place)), static_cast<float>(kSteps - 1));
    const Step& at = steps_[static_cast<std::size_t>(step)];
    const float part = place - step;
    return ((at.pose + part * at.change) * Eigen::Vector4f(point.x, point.y, point.z, 1.0F)).head<3>();
  }

  [[nodiscard]] std::int64_t start_utc_ns() const noexcept { return start_utc_ns_; }
  [[nodiscard]] const Velocity& velocity() const noexcept { return velocity_; }
  /// vehicle at that time <- vehicle at the start.
  [[nodiscard]] Pose from_start(std::int64_t stamp_utc_ns) const noexcept;

 private:
  // The motion is tabulated and interpolated: over 1.6 ms, even at 1 rad/s and 100 m, the chord is within
  // 0.1 mm of the arc. A sweep of 5 Hz is cut after 0.3 s; what comes later goes straight on.
  static constexpr float kSteps_per_s = 640.0F;
  static constexpr std::size_t kSteps = 192;

  struct Step {
    Eigen::Matrix4f pose;    ///< vehicle at the start <- sensor at the step
    Eigen::Matrix4f change;  ///< to the next
  };
  std::array<Step, kSteps> steps_;
  Velocity velocity_ = Velocity::Zero();
  std::int64_t start_utc_ns_ = 0;
};

}  // namespace landfix::ndt
