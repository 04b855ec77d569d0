#include "tools/replay_run.hpp"

#include <algorithm>
#include <limits>

#include "platform/heap_counter.hpp"
#include "platform/page_faults.hpp"

namespace landfix::tools {
namespace {

template <class Value>
[[nodiscard]] double mean_of(const std::vector<platform::SweepResult>& sweeps, Value value) {
  double sum = 0.0;
  double count = 0.0;
  for (const platform::SweepResult& sweep : sweeps) {
    if (sweep.missing) continue;
    sum += static_cast<double>(value(sweep));
    count += 1.0;
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<ndt::StampedPose> ReplayResult::trajectory() const {
  std::vector<ndt::StampedPose> poses;
  for (const platform::SweepResult& sweep : sweeps) {
    // Where the clock was set back, there is no pose until it has caught up: a trajectory's stamps rise.
    const bool rises = poses.empty() || sweep.fix.at.stamp_utc_ns > poses.back().stamp_utc_ns;
    if (rises && ndt::is_usable(sweep.fix.state)) poses.push_back(sweep.fix.at);
  }
  return poses;
}

std::size_t ReplayResult::count(ndt::State state) const {
  return static_cast<std::size_t>(
      std::count_if(sweeps.begin(), sweeps.end(),
                    [state](const platform::SweepResult& sweep) { return sweep.fix.state == state; }));
}

std::size_t ReplayResult::missing() const {
  return static_cast<std::size_t>(std::count_if(
      sweeps.begin(), sweeps.end(), [](const platform::SweepResult& sweep) { return sweep.missing; }));
}

std::size_t ReplayResult::partial() const {
  return static_cast<std::size_t>(
      std::count_if(sweeps.begin(), sweeps.end(),
                    [](const platform::SweepResult& sweep) { return !sweep.missing && !sweep.complete; }));
}

double ReplayResult::iterations_mean() const {
  return mean_of(sweeps, [](const platform::SweepResult& sweep) { return sweep.fix.match.iterations; });
}

double ReplayResult::points_mean() const {
  return mean_of(sweeps, [](const platform::SweepResult& sweep) { return sweep.points_filtered; });
}

ReplayResult run_replay(platform::PacketSource& source, platform::Pipeline& pipeline,
                        const std::function<void(const platform::SweepResult&)>& on_sweep,
                        std::span<const platform::StampedFrame> odometry) {
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
    while (is_packet && !odometry.empty() && odometry.front().stamp_utc_ns <= packet.receive_utc_ns) {
      pipeline.add_odometry(odometry.front().frame, odometry.front().stamp_utc_ns);
      odometry = odometry.subspan(1);
    }
    auto sweep = is_packet ? pipeline.predict_missing(packet.receive_utc_ns) : pipeline.finish();
    has_read = is_packet && sweep.has_value();
    if (is_packet && !has_read) sweep = pipeline.process(packet);
    platform::HeapCounter::disarm();
    const platform::PageFaults after = platform::thread_page_faults();
    result.page_faults += after.minor - before.minor + after.major - before.major;
    if (sweep) {
      result.sweeps.push_back(*sweep);
      on_sweep(*sweep);
    }
  }
  result.truncated = status == platform::ReadStatus::truncated;
  if (platform::HeapCounter::available()) result.heap_calls = platform::HeapCounter::calls();
  return result;
}

}  // namespace landfix::tools
