#include "tools/engine_setup.hpp"

#include "platform/packet_rate.hpp"
#include "platform/udp_settings.hpp"

namespace landfix::tools {
platform::EngineSettings engine_settings(const ReplaySetup& setup, platform::EngineMode mode) {
  constexpr double kNs_per_ms = 1e6;
  const platform::Configuration& configuration = setup.configuration;
  return {.mode = mode,
          .pipeline = setup.settings,
          .slot_bytes = platform::largest_packet_bytes(setup.model),
          .slots = platform::packet_ring_slots(setup.model),
          .rate_hz = configuration.can.rate_hz,
          .deadline_ns = static_cast<std::int64_t>(configuration.matcher.deadline_ms * kNs_per_ms),
          .realtime = configuration.realtime};
}

platform::PcapReceiverSettings pcap_settings(const ReplaySetup& setup, const std::filesystem::path& capture,
                                             double speed, std::uint64_t laps) {
  const platform::UdpSettings network = platform::udp_settings(setup.configuration.sensor, setup.model);
  return {.file = capture,
          .ports = network.ports,
          .sensor_address = network.sensor_address,
          .speed = speed,
          .laps = laps};
}

}  // namespace landfix::tools
