// The receiving thread: packets into the ring, and nothing else.
#pragma once

#include <atomic>

#include "platform/engine_links.hpp"
#include "platform/packet_receiver.hpp"
#include "platform/thread_watch.hpp"

namespace landfix::platform {

class ReceiveLoop {
 public:
  ReceiveLoop(EngineLinks& links, PacketReceiver& receiver) noexcept : links_(links), receiver_(receiver) {}

  /// Until the packets end or the engine stops.
  void run() noexcept;

  [[nodiscard]] const ThreadWatch& watch() const noexcept { return watch_; }
  /// Why the packets ended: ReceiveStatus::packets while they have not.
  [[nodiscard]] ReceiveStatus ending() const noexcept { return ending_.load(std::memory_order_relaxed); }

 private:
  EngineLinks& links_;
  PacketReceiver& receiver_;
  ThreadWatch watch_;
  std::atomic<ReceiveStatus> ending_{ReceiveStatus::packets};
};

}  // namespace landfix::platform
