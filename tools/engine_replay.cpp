#include "tools/engine_replay.hpp"

#include "platform/heap_counter.hpp"
#include "platform/monotonic_clock.hpp"
#include "platform/sleep_until.hpp"

namespace landfix::tools {
namespace {

void take_counts(platform::RunningEngine& engine, const platform::ReceiveCounters& received,
                 ReplayResult& result) {
  const platform::SolveStatus& status = engine.solve_status();
  result.pipeline = status.pipeline;
  result.pipeline.other_ports += received.other_ports;
  result.pipeline.other_senders += received.strangers;
  result.stream = status.stream;
  result.odometry = status.odometry;
  result.gnss = status.gnss;
  result.frames_dropped = engine.publish_counters().frames_dropped;
  result.poses_saturated = engine.publish_counters().poses_saturated;
  for (std::size_t i = 0; i < platform::kStageCount; ++i) {
    result.durations.push_back(engine.durations(static_cast<platform::Stage>(i)));
  }
  result.packets_dropped = received.dropped_ring_full;
  result.sweeps_skipped = status.counters.sweeps_skipped;
  result.deadline_misses = status.counters.deadline_misses;
  result.results_dropped = status.counters.fixes_dropped;
  result.truncated = engine.ending() == platform::ReceiveStatus::truncated;
  std::uint64_t heap_calls = 0;
  std::uint64_t locks = 0;
  for (const platform::EngineThread& thread : engine.threads()) {
    heap_calls += thread.watch->heap_calls();
    locks += thread.watch->locks();
    result.page_faults += static_cast<std::int64_t>(thread.watch->page_faults());
  }
  if (platform::HeapCounter::available()) {
    result.heap_calls = heap_calls;
    result.locks = locks;
  }
}

}  // namespace

ReplayResult run_engine(platform::RunningEngine& engine, const platform::ReceiveCounters& received,
                        bool keep_sweeps, const ReplayEvents& events) {
  constexpr std::int64_t kTurn_ns = 1'000'000;
  ReplayResult result;
  for (bool has_ended = false; !has_ended;) {
    has_ended = engine.has_ended();  // before the last look
    while (const auto sweep = engine.next_sweep()) {
      result.tally.add(sweep->result);
      if (keep_sweeps) result.sweeps.push_back(sweep->result);
      events.on_sweep(*sweep);
    }
    while (const auto sent = engine.next_sent()) events.on_sent(*sent);
    if (!has_ended) platform::sleep_until(platform::monotonic_ns() + kTurn_ns);
  }
  take_counts(engine, received, result);
  return result;
}

}  // namespace landfix::tools
