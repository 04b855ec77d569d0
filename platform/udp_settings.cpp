#include "platform/udp_settings.hpp"

#include "platform/ipv4.hpp"

namespace landfix::platform {

UdpSettings udp_settings(const SensorSettings& sensor, const drivers::SensorModel& model) {
  UdpSettings settings{
      .ports = {sensor.port != 0 ? sensor.port : model.data_port},
      .sensor_address = parse_ipv4(sensor.address).value_or(0),
      .multicast_group = parse_ipv4(sensor.multicast).value_or(0),
      .interface_address = parse_ipv4(sensor.interface).value_or(0),
      .receive_buffer_bytes = static_cast<std::size_t>(sensor.receive_buffer_mib * 1048576.0),
  };
  if (model.telemetry_port != 0 && model.telemetry_port != settings.ports[0])
    settings.ports.push_back(model.telemetry_port);
  return settings;
}

}  // namespace landfix::platform
