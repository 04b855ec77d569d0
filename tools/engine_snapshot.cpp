#include "tools/engine_snapshot.hpp"

#include <cstdio>
#include <memory>

#include <unistd.h>

#include "platform/heap_counter.hpp"
#include "platform/pose_report.hpp"

namespace landfix::tools {
namespace {

[[nodiscard]] std::uint64_t resident_bytes() {
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen("/proc/self/statm", "re"), close);
  unsigned long pages = 0;
  unsigned long resident_pages = 0;
  if (!file || std::fscanf(file.get(), "%lu %lu", &pages, &resident_pages) != 2) return 0;
  return resident_pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void add_pose(platform::EngineStatus& status, const platform::SweepResult& result) {
  const platform::PoseReport report = platform::report_of(result);
  status.state = result.fix.state;
  status.time_source = result.time_source;
  status.stamp_utc_ns = result.fix.at.stamp_utc_ns;
  status.pose = result.fix.at.pose;
  status.speed_mps = result.fix.velocity[0];
  status.sigma_along_m = report.sigma_along_m;
  status.sigma_cross_m = report.sigma_cross_m;
  status.sigma_yaw_rad = report.sigma_yaw_rad;
  status.score = report.score;
  status.iterations = result.fix.match.iterations;
  status.points = result.points_filtered;
}

void add_counts(platform::EngineStatus& status, const platform::SolveStatus& solve) {
  status.packets_rejected = solve.pipeline.rejected();
  status.packets_lost = solve.stream.lost_packets;
  status.sweeps = solve.counters.sweeps;
  status.sweeps_missing = solve.counters.sweeps_missing;
  status.sweeps_skipped = solve.counters.sweeps_skipped;
  status.deadline_misses = solve.counters.deadline_misses;
  status.fixes_dropped = solve.counters.fixes_dropped;
  status.points_dropped = solve.pipeline.points_overflowed + solve.pipeline.points_unfiltered;
  status.odometry = solve.odometry;
  status.gnss = solve.gnss;
  status.answers_late = solve.pipeline.answers_late;
  status.clock_steps = solve.stream.clock_steps;
  status.sensor_restarts = solve.stream.restarts;
}

void add_received(platform::EngineStatus& status, const platform::ReceiveCounters& received) {
  status.packets = received.packets;
  status.packets_dropped_kernel = received.dropped_by_kernel;
  status.packets_dropped_ring = received.dropped_ring_full;
  status.packets_truncated = received.truncated;
  status.packets_strangers = received.strangers;
  status.receive_errors = received.errors;
}

}  // namespace

platform::EngineStatus snapshot(const EngineView& view, std::int64_t now_mono_ns) {
  platform::EngineStatus status;
  status.version = LANDFIX_VERSION;
  status.sensor = view.sensor;
  status.uptime_s = static_cast<double>(now_mono_ns - view.began_mono_ns) * 1e-9;
  status.resident_bytes = resident_bytes();
  status.heap_is_counted = platform::HeapCounter::available();
  const platform::SolveStatus& solve = view.engine.solve_status();
  add_pose(status, solve.last.result);
  add_counts(status, solve);
  add_received(status, view.received);
  status.bus = view.bus.status();
  status.poses_saturated = view.engine.publish_counters().poses_saturated;
  for (std::size_t i = 0; i < platform::kStageCount; ++i) {
    status.stages[i] = platform::summarise(view.engine.durations(static_cast<platform::Stage>(i)));
  }
  for (const platform::EngineThread& thread : view.engine.threads()) {
    const std::int64_t since_ns = now_mono_ns - thread.watch->heartbeat().marked_ns();
    status.threads.push_back({.name = thread.name,
                              .advances = since_ns <= view.thread_budget_ns,
                              .page_faults = thread.watch->page_faults(),
                              .heap_calls = thread.watch->heap_calls()});
  }
  return status;
}

}  // namespace landfix::tools
