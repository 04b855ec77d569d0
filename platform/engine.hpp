// The vehicle's threads, assembled: rx receives, solve decodes and matches, tx sends. In two phases, each a
// type: an Engine is being set up and may allocate, wait and throw; a RunningEngine does none of it on the
// way of a pose.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/any_decoder.hpp"
#include "ndt/voxel_map.hpp"
#include "platform/can_frame.hpp"
#include "platform/engine_links.hpp"
#include "platform/latency_histogram.hpp"
#include "platform/packet_receiver.hpp"
#include "platform/pipeline.hpp"
#include "platform/pose_publisher.hpp"
#include "platform/realtime_settings.hpp"
#include "platform/thread_watch.hpp"
#include "platform/watchdog.hpp"

namespace landfix::platform {

struct EngineSettings {
  EngineMode mode = EngineMode::live;
  PipelineSettings pipeline;
  std::size_t slot_bytes = 0;    ///< the sensor's largest packet
  std::size_t slots = 0;         ///< of the packet ring
  double rate_hz = 10.0;         ///< of the poses on a live bus
  std::int64_t deadline_ns = 0;  ///< from a sweep's last packet to the end of its match; 0: none
  RealtimeSettings realtime;
};

/// The loops of the three threads, and what lies between them.
struct EngineParts;

/// Everything that runs is allocated, touched and warmed here.
class Engine {
 public:
  /// The memory that `map` views, and the rest, must outlive the engine, and the RunningEngine that it
  /// becomes. Throws std::runtime_error where memory cannot be had.
  Engine(const EngineSettings& settings, const drivers::AnyDecoder& decoder, const ndt::VoxelMap& map,
         const MapAids& aids, PacketReceiver& receiver, FrameSink* bus, FrameSource* vehicle_bus = nullptr);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

 private:
  friend class RunningEngine;
  std::unique_ptr<EngineParts> parts_;
};

/// A thread of the engine, as whoever watches sees it.
struct EngineThread {
  const char* name = "";
  const ThreadWatch* watch = nullptr;
};

/// From construction to stop() nothing on the way of a pose allocates, locks or waits for anyone but its
/// packets. All functions are for one thread, which keeps house.
class RunningEngine {
 public:
  /// Locks the memory and begins. Throws std::runtime_error where a thread cannot be had, or rights that are
  /// required are missing.
  explicit RunningEngine(Engine&& ready);
  /// Stops.
  ~RunningEngine();
  RunningEngine(const RunningEngine&) = delete;
  RunningEngine& operator=(const RunningEngine&) = delete;

  /// What of the real-time settings it does without, a sentence each.
  [[nodiscard]] const std::vector<std::string>& missing() const noexcept;

  /// The next sweep's result, in order; nothing while there is none. To be asked often: see
  /// SolveCounters::fixes_dropped.
  [[nodiscard]] std::optional<SolvedSweep> next_sweep() noexcept;
  [[nodiscard]] std::optional<SentSweep> next_sent() noexcept;
  /// The packets have ended and every result has been sent; not all may have been asked for.
  [[nodiscard]] bool has_ended() const noexcept;
  /// Why the packets ended; ReceiveStatus::packets while they have not.
  [[nodiscard]] ReceiveStatus ending() const noexcept;
  /// Ends the threads, within the longest of their waits (100 ms) and one match. Results may still be asked
  /// for.
  void stop() noexcept;

  /// As of the last sweep.
  [[nodiscard]] const SolveStatus& solve_status() noexcept;
  [[nodiscard]] const PublishCounters& publish_counters() const noexcept;
  [[nodiscard]] const LatencyHistogram& durations(Stage stage) const noexcept;
  [[nodiscard]] std::array<EngineThread, 3> threads() const noexcept;

 private:
  std::unique_ptr<EngineParts> parts_;
};

}  // namespace landfix::platform
