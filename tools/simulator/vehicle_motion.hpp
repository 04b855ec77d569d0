// The vehicle's way through the world: its pose at any time. This is the truth.
#pragma once

#include <array>
#include <vector>

#include "ndt/pose.hpp"
#include "tools/simulator/ground.hpp"
#include "tools/simulator/route.hpp"

namespace landfix::tools::simulator {

/// A cubic spline through finely spaced poses: continuous, and so is its velocity.
class VehicleMotion {
 public:
  VehicleMotion(const Route& route, const Ground& ground);

  [[nodiscard]] double duration_s() const noexcept;
  /// `map <- vehicle`; before the start and after the end the vehicle stands.
  [[nodiscard]] ndt::Pose pose_at(double time_s) const noexcept;
  /// Along the road since the start [m], and how fast [m/s].
  [[nodiscard]] double station_at(double time_s) const noexcept;
  [[nodiscard]] double speed_at(double time_s) const noexcept;

 private:
  /// x, y, z [m], roll, pitch, yaw [rad] (yaw counts full turns), station [m].
  using Knot = Eigen::Matrix<double, 7, 1>;

  [[nodiscard]] Knot value_at(double time_s) const noexcept;

  std::vector<Knot> knots_;
};

}  // namespace landfix::tools::simulator
