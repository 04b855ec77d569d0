// Poses onto the bus: encoded, counted, sent.
#pragma once

#include <cstdint>

#include "platform/can_frame.hpp"
#include "platform/map_reference.hpp"
#include "platform/pose_frames.hpp"
#include "platform/pose_report.hpp"
#include "platform/relaxed_counter.hpp"

namespace landfix::platform {

struct PublishSettings {
  std::uint32_t can_base_id = 0x3A0;
  bool can_fd = false;
  MapReference map{};  ///< told on the bus
};

struct PublishCounters {
  RelaxedCounter poses;            ///< whose frames were all taken
  RelaxedCounter frames_dropped;   ///< that the bus did not take
  RelaxedCounter poses_saturated;  ///< with a value beyond its signal's range
};

class PosePublisher {
 public:
  /// `bus` must outlive it; without one nothing is published.
  PosePublisher(const PublishSettings& settings, FrameSink* bus) noexcept
      : settings_(settings),
        encoder_(settings.can_base_id, settings.can_fd, settings.map.projection.has_value()),
        bus_(bus) {}

  /// `sent_utc_ns`: the time of sending, as a log says it.
  void publish(PoseReport report, std::int64_t sent_utc_ns) noexcept;

  [[nodiscard]] const PublishCounters& counters() const noexcept { return counters_; }

 private:
  PublishSettings settings_;
  PoseFrameEncoder encoder_;
  FrameSink* bus_;
  PublishCounters counters_;
};

}  // namespace landfix::platform
