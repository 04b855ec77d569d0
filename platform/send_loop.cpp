#include "platform/send_loop.hpp"

#include <algorithm>

#include "ndt/motion.hpp"
#include "platform/monotonic_clock.hpp"
#include "platform/utc_clock.hpp"

namespace landfix::platform {

PoseReport report_at(const SolvedSweep& sweep, std::int64_t now_mono_ns) noexcept {
  constexpr std::int64_t kTooOld_ns = 1'000'000'000;  // a sweep that is missing is predicted long before
  const std::int64_t since_ns = std::max<std::int64_t>(0, now_mono_ns - sweep.arrived_mono_ns);
  SweepResult moved = sweep.result;
  ndt::Fix& fix = moved.fix;
  fix.at.stamp_utc_ns += since_ns;
  fix.at.pose = ndt::predict(sweep.result.fix.at, fix.velocity, fix.at.stamp_utc_ns);
  if (since_ns > kTooOld_ns) fix.state = ndt::State::no_data;
  return report_of(moved);
}

void SendLoop::run() noexcept {
  constexpr std::int64_t kLongestWait_ns = 100'000'000;
  watch_.begin();
  while (!links_.stop.load(std::memory_order_relaxed)) {
    watch_.beat();
    const bool is_last_look = links_.fixes_ended.load(std::memory_order_acquire);
    if (bus_ != nullptr) bus_->maintain(monotonic_ns());
    SolvedSweep sweep;
    while (links_.fixes.pop(sweep)) take(sweep);
    if (links_.mode == EngineMode::live) send_due();
    if (is_last_look) break;
    std::int64_t next_look = monotonic_ns() + kLongestWait_ns;
    if (links_.mode == EngineMode::live) next_look = std::min(next_look, schedule_.due_ns());
    links_.fixes_bell.wait(next_look);
  }
  if (links_.mode == EngineMode::live) publisher_.publish(idle_report(ndt::State::no_data), utc_ns());
  watch_.end();
}

void SendLoop::take(const SolvedSweep& sweep) noexcept {
  const std::int64_t now = monotonic_ns();
  if (links_.mode == EngineMode::live) {
    latest_ = sweep;
    is_fresh_ = true;
    schedule_.take_fix(now);
    return;
  }
  if (!sweep.result.late) publisher_.publish(report_of(sweep.result), sweep.result.fix.at.stamp_utc_ns);
  record_sweep(sweep, now);
}

void SendLoop::send_due() noexcept {
  const std::int64_t now = monotonic_ns();
  if (now < schedule_.due_ns()) return;
  publisher_.publish(latest_ ? report_at(*latest_, now) : idle_report(ndt::State::init), utc_ns());
  schedule_.sent(now);
  if (is_fresh_) record_sweep(*latest_, now);
  is_fresh_ = false;
}

void SendLoop::record_sweep(const SolvedSweep& sweep, std::int64_t began_mono_ns) noexcept {
  const std::int64_t ended = monotonic_ns();
  publish_.record(ended - began_mono_ns);
  if (!sweep.result.missing && links_.mode != EngineMode::fast_replay)
    total_.record(ended - sweep.arrived_mono_ns);
  // Where house has no room it is one span less in a trace.
  (void)links_.sent.push({.stamp_utc_ns = sweep.result.fix.at.stamp_utc_ns,
                          .began_mono_ns = began_mono_ns,
                          .ended_mono_ns = ended});
  watch_.look();
}

PoseReport SendLoop::idle_report(ndt::State state) noexcept {
  PoseReport report;
  report.stamp_utc_ns = utc_ns();
  report.state = static_cast<std::uint16_t>(state);
  return report;
}

}  // namespace landfix::platform
