// A replay through the vehicle's own threads, and what came out of it.
#pragma once

#include <functional>

#include "platform/engine.hpp"
#include "platform/packet_receiver.hpp"
#include "tools/replay_run.hpp"

namespace landfix::tools {

/// Called in the thread that runs the replay.
struct ReplayEvents {
  std::function<void(const platform::SolvedSweep&)> on_sweep = [](const platform::SolvedSweep&) {};
  std::function<void(const platform::SentSweep&)> on_sent = [](const platform::SentSweep&) {
  };  ///< after its sweep
};

/// Until the packets have ended and everything is sent. `keep_sweeps`: else only their tally is kept, so that
/// memory does not grow with the replay.
[[nodiscard]] ReplayResult run_engine(platform::RunningEngine& engine,
                                      const platform::ReceiveCounters& received, bool keep_sweeps,
                                      const ReplayEvents& events = {});

}  // namespace landfix::tools
