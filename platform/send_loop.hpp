// The sending thread: poses to the bus. A replay sends each sweep's pose as it is, so that two replays give
// the same log; a live engine sends at a steady rate, each pose predicted to the time at which it is sent.
#pragma once

#include <cstdint>
#include <optional>

#include "platform/can_frame.hpp"
#include "platform/engine_links.hpp"
#include "platform/latency_histogram.hpp"
#include "platform/pose_publisher.hpp"
#include "platform/send_schedule.hpp"
#include "platform/thread_watch.hpp"

namespace landfix::platform {

/// The pose of a sweep as it is sent at `now_mono_ns`: moved on at its velocity, by the monotonic clock.
/// NO_DATA if it is too old for that.
[[nodiscard]] PoseReport report_at(const SolvedSweep& sweep, std::int64_t now_mono_ns) noexcept;

class SendLoop {
 public:
  SendLoop(EngineLinks& links, const PublishSettings& settings, double rate_hz, FrameSink* bus) noexcept
      : links_(links), publisher_(settings, bus), schedule_(rate_hz), bus_(bus) {}

  /// Until the last fix is sent, or the engine stops; a live one then says NO_DATA.
  void run() noexcept;

  [[nodiscard]] const ThreadWatch& watch() const noexcept { return watch_; }
  [[nodiscard]] const PublishCounters& counters() const noexcept { return publisher_.counters(); }
  [[nodiscard]] const LatencyHistogram& publish_time() const noexcept { return publish_; }
  /// From the arrival of a sweep's last packet until its frames were handed to the bus.
  [[nodiscard]] const LatencyHistogram& total() const noexcept { return total_; }

 private:
  void take(const SolvedSweep& sweep) noexcept;
  void send_due() noexcept;
  void record_sweep(const SolvedSweep& sweep, std::int64_t began_mono_ns) noexcept;
  [[nodiscard]] static PoseReport idle_report(ndt::State state) noexcept;

  EngineLinks& links_;
  PosePublisher publisher_;
  SendSchedule schedule_;
  FrameSink* bus_;
  ThreadWatch watch_;
  LatencyHistogram publish_;
  LatencyHistogram total_;
  std::optional<SolvedSweep> latest_;
  bool is_fresh_ = false;  ///< the latest has not been sent
};

}  // namespace landfix::platform
