// All that passes between the engine's threads, each way with one writer and one reader:
//
//   rx -- packets --> solve -- fixes --> tx --> bus
//                       |                 |
//                       |-- sweeps -----> house <-- sent
//                       |-- status -----> house
#pragma once

#include <atomic>
#include <cstdint>

#include "drivers/stream_counters.hpp"
#include "platform/doorbell.hpp"
#include "platform/packet_ring.hpp"
#include "platform/pipeline.hpp"
#include "platform/relaxed_counter.hpp"
#include "platform/spsc_ring.hpp"
#include "platform/triple_buffer.hpp"

namespace landfix::platform {

/// What drives an engine, and what it does when it cannot keep up.
enum class EngineMode : std::uint8_t {
  live,          ///< the clock drives it; what is too much is dropped and counted
  paced_replay,  ///< the packets' times drive it; what is too much is dropped and counted
  fast_replay,   ///< the packets' times drive it; whoever is ahead waits, and nothing is dropped
};

/// A sweep's result on its way.
struct SolvedSweep {
  SweepResult result;
  /// When its last packet came, or for a sweep that did not come, when it should have.
  std::int64_t arrived_mono_ns = 0;
};

/// When a sweep's pose was put on the bus.
struct SentSweep {
  std::int64_t stamp_utc_ns = 0;  ///< the sweep's
  std::int64_t began_mono_ns = 0;
  std::int64_t ended_mono_ns = 0;
};

struct SolveCounters {
  std::uint64_t sweeps = 0;           ///< that came, whole or in part
  std::uint64_t sweeps_missing = 0;   ///< that did not come and were predicted
  std::uint64_t sweeps_skipped = 0;   ///< that were not matched, as newer packets were waiting
  std::uint64_t deadline_misses = 0;  ///< matches that were stopped in time
  std::uint64_t fixes_dropped = 0;    ///< that tx or house had no room for
};

/// Of the solving thread, after each sweep.
struct SolveStatus {
  SolvedSweep last;
  SolveCounters counters;
  PipelineCounters pipeline;
  drivers::StreamCounters stream;
  OdometryStatus odometry;
  GnssCounters gnss;
};

struct EngineLinks {
  EngineLinks(EngineMode engine_mode, std::size_t slot_bytes, std::size_t slots)
      : mode(engine_mode), packets(slot_bytes, slots) {}

  EngineMode mode;
  PacketRing packets;
  Doorbell packets_bell;
  std::atomic<bool> packets_ended{false};  ///< release by rx after the last packet, acquire by solve

  SpscRing<SolvedSweep, 16> fixes;
  Doorbell fixes_bell;
  std::atomic<bool> fixes_ended{false};  ///< release by solve after the last fix, acquire by tx

  SpscRing<SolvedSweep, 64> sweeps;
  SpscRing<SentSweep, 64> sent;
  TripleBuffer<SolveStatus> status;

  std::atomic<bool> stop{false};  ///< relaxed: nothing is read along with it
};

}  // namespace landfix::platform
