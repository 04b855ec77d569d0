// How far a prediction at constant velocity may be off: what the weak directions, and the distortion of a
// sweep, are uncertain by.
#pragma once

#include <optional>

#include "ndt/pose.hpp"

namespace landfix::ndt {

/// Along one direction: the variances of position and velocity, and their covariance.
class DeadReckoning {
 public:
  /// At a guess, before any velocity is known.
  DeadReckoning() noexcept = default;

  /// The direction was held by a match: nothing is owed to prediction any more. `velocity_known`: two matches
  /// have shown it.
  void hold(bool velocity_known) noexcept;
  /// Nothing has shown where it is for `duration_s`. `speed_sigma_mps`: but something has measured the speed.
  void pass(double duration_s, std::optional<double> speed_sigma_mps = std::nullopt) noexcept;

  /// Of a displacement of the vehicle or of the points around it.
  [[nodiscard]] double sigma_m() const noexcept;
  /// Of all six directions, as a Twist in the vehicle's axes.
  [[nodiscard]] Matrix6 covariance() const noexcept;

 private:
  static constexpr double kAnyGuess_m = 1.0;
  static constexpr double kAnySpeed_mps = 15.0;
  static constexpr double kVelocityNoise_mps = 0.15;
  /// How a driver changes the speed: white acceleration, 0.5 m/s after a second.
  static constexpr double kAcceleration2_m2ps3 = 0.25;

  double position2_m2_ = kAnyGuess_m * kAnyGuess_m;
  double both_m2ps_ = 0.0;
  double velocity2_m2ps2_ = kAnySpeed_mps * kAnySpeed_mps;
};

/// The mean squares of how the vehicle's motion surprises, a sweep: heave, roll and pitch that are taken for
/// 0, and changes of what is taken for constant. Half of that is what a sweep's distortion is wrong by, as
/// its points are spread over its time.
class SweepDistortion {
 public:
  /// `surprise`: from where the prediction led to where the match is, frame `vehicle`.
  void observe(const Twist& surprise) noexcept;

  /// Of a pose whose sweep was undone with the predicted velocity, as a Twist in the vehicle's axes.
  [[nodiscard]] Matrix6 covariance() const noexcept;

 private:
  static constexpr double kShare = 0.05;  // of the newest: the memory of 2 s at 10 Hz
  Twist mean_square_ = (Twist() << 1e-4, 1e-4, 1e-4, 1e-6, 1e-6, 1e-6).finished();
};

}  // namespace landfix::ndt
