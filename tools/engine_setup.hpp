// From what a replay needs to what the vehicle's threads need.
#pragma once

#include "platform/engine.hpp"
#include "platform/pcap_receiver.hpp"
#include "tools/replay_setup.hpp"

namespace landfix::tools {

[[nodiscard]] platform::EngineSettings engine_settings(const ReplaySetup& setup, platform::EngineMode mode);

/// `speed`: recorded time over real time; 0: as fast as it is solved.
[[nodiscard]] platform::PcapReceiverSettings pcap_settings(const ReplaySetup& setup,
                                                           const std::filesystem::path& capture, double speed,
                                                           std::uint64_t laps);

}  // namespace landfix::tools
