#include "tools/replay_run.hpp"

#include <algorithm>
#include <limits>

#include "platform/heap_counter.hpp"
#include "platform/page_faults.hpp"

namespace landfix::tools {
namespace {

template <class Value>
[[nodiscard]] double mean_of(const std::vector<platform::SweepResult>& sweeps, Value value) {
  if (sweeps.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (const platform::SweepResult& sweep : sweeps) sum += static_cast<double>(value(sweep));
  return sum / static_cast<double>(sweeps.size());
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

std::size_t ReplayResult::partial() const {
  return static_cast<std::size_t>(std::count_if(
      sweeps.begin(), sweeps.end(), [](const platform::SweepResult& sweep) { return !sweep.complete; }));
}

double ReplayResult::iterations_mean() const {
  return mean_of(sweeps, [](const platform::SweepResult& sweep) { return sweep.fix.match.iterations; });
}

double ReplayResult::points_mean() const {
  return mean_of(sweeps, [](const platform::SweepResult& sweep) { return sweep.points_filtered; });
}

ReplayResult run_replay(platform::PacketSource& source, platform::Pipeline& pipeline,
                        const std::function<void(const platform::SweepResult&)>& on_sweep) {
  ReplayResult result;
  for (;;) {
    // What the vehicle does from packet to pose is watched; keeping the result is the replay's own affair.
    const platform::PageFaults before = platform::thread_page_faults();
    platform::HeapCounter::arm();
    platform::UdpPacket packet;
    const platform::ReadStatus status = source.next(packet);
    const auto sweep = status == platform::ReadStatus::packet ? pipeline.process(packet) : pipeline.finish();
    platform::HeapCounter::disarm();
    const platform::PageFaults after = platform::thread_page_faults();
    result.page_faults += after.minor - before.minor + after.major - before.major;
    if (sweep) {
      result.sweeps.push_back(*sweep);
      on_sweep(*sweep);
    }
    if (status != platform::ReadStatus::packet) {
      result.truncated = status == platform::ReadStatus::truncated;
      break;
    }
  }
  if (platform::HeapCounter::available()) result.heap_calls = platform::HeapCounter::calls();
  return result;
}

}  // namespace landfix::tools
