#include "platform/odometry_configuration.hpp"

#include <array>

#include "platform/vehicle_signal_configuration.hpp"

namespace landfix::platform {

void read_odometry(TomlSection section, OdometrySettings& odometry) {
  constexpr std::array kRoles{VehicleRole::speed,    VehicleRole::wheel_fl, VehicleRole::wheel_fr,
                              VehicleRole::wheel_rl, VehicleRole::wheel_rr, VehicleRole::yaw_rate,
                              VehicleRole::reverse};
  section.read("track_m", odometry.track_m, {0.0, 5.0});
  read_vehicle_signals(section, "odometry", kRoles, odometry);
}

}  // namespace landfix::platform
