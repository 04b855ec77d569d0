// A replay: the pipeline fed from a capture, and what came out of it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "ndt/pose.hpp"
#include "platform/can_frame.hpp"
#include "platform/pcap_source.hpp"
#include "platform/pipeline.hpp"
#include "tools/replay_tally.hpp"

namespace landfix::tools {

struct ReplayResult {
  std::vector<platform::SweepResult> sweeps;  ///< in the order of publishing, with the missing ones
  ReplayTally tally;                          ///< of all of them, also where they are not kept
  platform::PipelineCounters pipeline;
  drivers::StreamCounters stream;
  platform::OdometryStatus odometry;
  platform::GnssCounters gnss;
  std::uint64_t frames_dropped = 0;                   ///< that the bus did not take
  std::uint64_t poses_saturated = 0;                  ///< with a value beyond its signal's range
  std::vector<platform::LatencyHistogram> durations;  ///< by Stage
  bool truncated = false;                             ///< the capture ends in the middle of a record

  // Of a replay in threads that was too fast for this computer.
  std::uint64_t packets_dropped = 0;  ///< the ring was full
  std::uint64_t sweeps_skipped = 0;   ///< not matched, as newer packets were waiting
  std::uint64_t deadline_misses = 0;  ///< matches that were stopped in time
  std::uint64_t results_dropped = 0;

  // In receiving, solving and publishing, not in keeping the results; nothing where it cannot be counted.
  std::optional<std::uint64_t> heap_calls;
  std::optional<std::uint64_t> locks;
  std::int64_t page_faults = 0;

  /// The usable poses: PREDICTED, DEGRADED, TRACKING; with rising stamps.
  [[nodiscard]] std::vector<ndt::StampedPose> trajectory() const;
  [[nodiscard]] const platform::LatencyHistogram& duration(platform::Stage stage) const {
    return durations[static_cast<std::size_t>(stage)];
  }
};

/// Feeds all of `source` to the pipeline, and before each packet the frames of `vehicle_bus` that came
/// earlier. `on_sweep` is called after each sweep, for progress.
[[nodiscard]] ReplayResult run_replay(platform::PacketSource& source, platform::Pipeline& pipeline,
                                      const std::function<void(const platform::SweepResult&)>& on_sweep,
                                      platform::FrameSource* vehicle_bus = nullptr);

}  // namespace landfix::tools
