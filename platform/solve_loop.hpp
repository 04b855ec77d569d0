// The solving thread: packets from the ring through the pipeline, results to whoever waits for them.
#pragma once

#include <cstdint>

#include "platform/engine_links.hpp"
#include "platform/latency_histogram.hpp"
#include "platform/pipeline.hpp"
#include "platform/thread_watch.hpp"

namespace landfix::platform {

class SolveLoop {
 public:
  /// `vehicle_bus`: frames of the vehicle's bus, or null. `deadline_ns`: from a sweep's last packet to the
  /// end of its match; 0: none.
  SolveLoop(EngineLinks& links, Pipeline& pipeline, FrameSource* vehicle_bus,
            std::int64_t deadline_ns) noexcept
      : links_(links), pipeline_(pipeline), vehicle_bus_(vehicle_bus), deadline_ns_(deadline_ns) {}

  /// Until the packets have ended and all of them are solved, or the engine stops.
  void run() noexcept;

  [[nodiscard]] const ThreadWatch& watch() const noexcept { return watch_; }
  [[nodiscard]] const LatencyHistogram& kernel_receive() const noexcept { return kernel_receive_; }
  [[nodiscard]] const LatencyHistogram& ring_wait() const noexcept { return ring_wait_; }

 private:
  /// False if there was none.
  bool solve_packet() noexcept;
  void listen(std::int64_t now_utc_ns) noexcept;
  void predict_until(std::int64_t now_utc_ns) noexcept;
  void wait() noexcept;
  void say_that_none_came(std::int64_t now_utc_ns) noexcept;
  void take(const SweepResult& result, std::int64_t arrived_mono_ns) noexcept;
  void publish_status() noexcept;
  void pass_on(const SweepResult& result, std::int64_t arrived_mono_ns) noexcept;
  [[nodiscard]] SweepOrders orders(const PacketHeader& header) noexcept;
  template <class Ring>
  void push(Ring& ring, const SolvedSweep& sweep) noexcept;

  EngineLinks& links_;
  Pipeline& pipeline_;
  FrameSource* vehicle_bus_;
  std::int64_t deadline_ns_;
  ThreadWatch watch_;
  LatencyHistogram kernel_receive_;
  LatencyHistogram ring_wait_;
  SolveCounters counters_;
  SolvedSweep last_;
  std::size_t packets_of_sweep_ = 0;       ///< of the current one, so far
  std::size_t packets_of_last_sweep_ = 0;  ///< 0: there is none yet
  std::int64_t listen_due_ns_ = 0;
  std::int64_t silence_due_ns_ = 0;  ///< before the first sweep; 0: not begun
  std::int64_t last_stamp_utc_ns_ = 0;
  std::int64_t last_arrived_mono_ns_ = 0;
};

}  // namespace landfix::platform
