#include "platform/pose_publisher.hpp"

namespace landfix::platform {

void PosePublisher::publish(PoseReport report, std::int64_t sent_utc_ns) noexcept {
  if (bus_ == nullptr) return;
  settings_.map.add_to(report);
  const PoseFrames encoded = encoder_.encode(report);
  const std::size_t dropped = encoded.count - bus_->send(encoded.all(), sent_utc_ns);
  counters_.frames_dropped += dropped;
  if (dropped == 0) ++counters_.poses;
  if (encoded.saturated) ++counters_.poses_saturated;
}

}  // namespace landfix::platform
