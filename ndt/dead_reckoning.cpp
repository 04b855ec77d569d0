#include "ndt/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>

namespace landfix::ndt {

void DeadReckoning::hold(bool velocity_known) noexcept {
  position2_m2_ = 0.0;
  both_m2ps_ = 0.0;
  if (velocity_known) velocity2_m2ps2_ = kVelocityNoise_mps * kVelocityNoise_mps;
}

void DeadReckoning::pass(double duration_s, std::optional<double> speed_sigma_mps) noexcept {
  const double t = duration_s;
  if (speed_sigma_mps) {
    velocity2_m2ps2_ = *speed_sigma_mps * *speed_sigma_mps;
    // No more than position and velocity can have in common.
    both_m2ps_ = std::min(both_m2ps_, std::sqrt(position2_m2_) * *speed_sigma_mps);
    position2_m2_ += 2.0 * t * both_m2ps_ + t * t * velocity2_m2ps2_;
    both_m2ps_ += t * velocity2_m2ps2_;
    return;
  }
  position2_m2_ += 2.0 * t * both_m2ps_ + t * t * velocity2_m2ps2_ + kAcceleration2_m2ps3 * t * t * t / 3.0;
  both_m2ps_ += t * velocity2_m2ps2_ + kAcceleration2_m2ps3 * t * t / 2.0;
  velocity2_m2ps2_ += kAcceleration2_m2ps3 * t;
}

double DeadReckoning::sigma_m() const noexcept { return std::sqrt(position2_m2_); }

Matrix6 DeadReckoning::covariance() const noexcept {
  constexpr double kPointDistance_m = 10.0;
  Twist variance = Twist::Constant(position2_m2_);
  variance.tail<3>() /= kPointDistance_m * kPointDistance_m;
  return variance.asDiagonal();
}

void SweepDistortion::observe(const Twist& surprise) noexcept {
  mean_square_ += kShare * (surprise.cwiseAbs2() - mean_square_);
}

Matrix6 SweepDistortion::covariance() const noexcept { return (0.25 * mean_square_).asDiagonal(); }

}  // namespace landfix::ndt
