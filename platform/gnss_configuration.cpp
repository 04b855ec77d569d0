#include "platform/gnss_configuration.hpp"

#include <array>

#include "platform/vehicle_signal_configuration.hpp"

namespace landfix::platform {

void read_gnss(TomlSection section, GnssSettings& gnss) {
  constexpr std::array kRoles{VehicleRole::latitude, VehicleRole::longitude, VehicleRole::altitude,
                              VehicleRole::heading};
  section.read("antenna", gnss.antenna_m);
  section.read("accuracy_m", gnss.accuracy_m, {0.1, 50.0});
  read_vehicle_signals(section, "gnss", kRoles, gnss);
  if (gnss.count != 0 && !(gnss.has(VehicleRole::latitude) && gnss.has(VehicleRole::longitude)))
    section.fail("signal", "both latitude and longitude");
}

}  // namespace landfix::platform
