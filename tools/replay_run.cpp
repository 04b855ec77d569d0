#include "tools/replay_run.hpp"

#include "platform/heap_counter.hpp"
#include "platform/page_faults.hpp"

namespace landfix::tools {
std::vector<ndt::StampedPose> ReplayResult::trajectory() const {
  std::vector<ndt::StampedPose> poses;
  for (const platform::SweepResult& sweep : sweeps) {
    // Where the clock was set back, there is no pose until it has caught up: a trajectory's stamps rise.
    const bool rises = poses.empty() || sweep.fix.at.stamp_utc_ns > poses.back().stamp_utc_ns;
    if (rises && ndt::is_usable(sweep.fix.state)) poses.push_back(sweep.fix.at);
  }
  return poses;
}

ReplayResult run_replay(platform::PacketSource& source, platform::Pipeline& pipeline,
                        const std::function<void(const platform::SweepResult&)>& on_sweep,
                        platform::FrameSource* vehicle_bus) {
  ReplayResult result;
  platform::UdpPacket packet;
  platform::ReadStatus status = platform::ReadStatus::packet;
  bool has_read = false;  // a packet that waits until nothing is missing before it
  while (status == platform::ReadStatus::packet) {
    // What the vehicle does from packet to pose is watched; keeping the result is the replay's own affair.
    const platform::PageFaults before = platform::thread_page_faults();
    platform::HeapCounter::arm();
    if (!has_read) status = source.next(packet);
    const bool is_packet = status == platform::ReadStatus::packet;
    if (is_packet && vehicle_bus != nullptr) pipeline.listen(*vehicle_bus, packet.receive_utc_ns);
    auto sweep = is_packet ? pipeline.predict_missing(packet.receive_utc_ns) : pipeline.finish();
    has_read = is_packet && sweep.has_value();
    if (is_packet && !has_read) sweep = pipeline.process(packet);
    platform::HeapCounter::disarm();
    const platform::PageFaults after = platform::thread_page_faults();
    result.page_faults += after.minor - before.minor + after.major - before.major;
    if (sweep) {
      result.tally.add(*sweep);
      result.sweeps.push_back(*sweep);
      on_sweep(*sweep);
    }
  }
  result.truncated = status == platform::ReadStatus::truncated;
  result.pipeline = pipeline.counters();
  result.stream = pipeline.stream_counters();
  result.odometry = pipeline.odometry().status();
  result.gnss = pipeline.gnss().counters();
  result.frames_dropped = pipeline.publish_counters().frames_dropped;
  result.poses_saturated = pipeline.publish_counters().poses_saturated;
  for (std::size_t i = 0; i < platform::kStageCount; ++i) {
    result.durations.push_back(pipeline.durations(static_cast<platform::Stage>(i)));
  }
  if (platform::HeapCounter::available()) {
    result.heap_calls = platform::HeapCounter::calls();
    result.locks = platform::HeapCounter::locks();
  }
  return result;
}

}  // namespace landfix::tools
