// The running engine at a moment, gathered from where its threads leave it.
#pragma once

#include <cstdint>
#include <string>

#include "platform/engine.hpp"
#include "platform/engine_status.hpp"
#include "platform/packet_receiver.hpp"
#include "platform/socket_can.hpp"

namespace landfix::tools {

/// What belongs to an engine while it runs.
struct EngineView {
  platform::RunningEngine& engine;
  const platform::ReceiveCounters& received;
  const platform::SocketCan& bus;
  std::string sensor;
  std::int64_t began_mono_ns;
  std::int64_t thread_budget_ns;  ///< from one mark of a thread's heartbeat to the next
};

[[nodiscard]] platform::EngineStatus snapshot(const EngineView& view, std::int64_t now_mono_ns);

}  // namespace landfix::tools
