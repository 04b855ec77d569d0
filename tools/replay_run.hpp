// A replay: the pipeline fed from a capture, and what came out of it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "ndt/pose.hpp"
#include "platform/can_frame.hpp"
#include "platform/pcap_source.hpp"
#include "platform/pipeline.hpp"

namespace landfix::tools {

struct ReplayResult {
  std::vector<platform::SweepResult> sweeps;  ///< in the order of publishing, with the missing ones
  bool truncated = false;                     ///< the capture ends in the middle of a record

  // In receiving, solving and publishing, not in keeping the results; nothing where it cannot be counted.
  std::optional<std::uint64_t> heap_calls;
  std::int64_t page_faults = 0;

  /// The usable poses: PREDICTED, DEGRADED, TRACKING; with rising stamps.
  [[nodiscard]] std::vector<ndt::StampedPose> trajectory() const;
  [[nodiscard]] std::size_t count(ndt::State state) const;
  [[nodiscard]] std::size_t missing() const;  ///< of `sweeps`, those that have not come
  [[nodiscard]] std::size_t partial() const;  ///< of those that came, the ones that are not whole turns
  // Of those that came; NaN where none did.
  [[nodiscard]] double iterations_mean() const;
  [[nodiscard]] double points_mean() const;  ///< after the filter
};

/// Feeds all of `source` to the pipeline, and before each packet the frames of `odometry` that came earlier.
/// `on_sweep` is called after each sweep, for progress.
[[nodiscard]] ReplayResult run_replay(platform::PacketSource& source, platform::Pipeline& pipeline,
                                      const std::function<void(const platform::SweepResult&)>& on_sweep,
                                      std::span<const platform::StampedFrame> odometry = {});

}  // namespace landfix::tools
