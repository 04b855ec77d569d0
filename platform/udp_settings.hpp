// Where the packets of a sensor come in from the network.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/sensor_model.hpp"
#include "platform/configuration.hpp"

namespace landfix::platform {

/// Addresses are IPv4, in host byte order.
struct UdpSettings {
  std::vector<std::uint16_t> ports{};   ///< the first is the data's; 0: any that is free
  std::uint32_t sensor_address = 0;     ///< 0: whoever sends
  std::uint32_t multicast_group = 0;    ///< 0: unicast and broadcast
  std::uint32_t interface_address = 0;  ///< of this computer; 0: any
  std::size_t receive_buffer_bytes = std::size_t{16} << 20U;  ///< of the data's port, as the kernel counts
};

/// The data's port, and the telemetry's where the model has another.
[[nodiscard]] UdpSettings udp_settings(const SensorSettings& sensor, const drivers::SensorModel& model);

}  // namespace landfix::platform
