#include "platform/solve_loop.hpp"

#include "platform/monotonic_clock.hpp"
#include "platform/sleep_until.hpp"
#include "platform/utc_clock.hpp"

namespace landfix::platform {
void SolveLoop::run() noexcept {
  watch_.begin();
  while (!links_.stop.load(std::memory_order_relaxed)) {
    watch_.beat();
    const bool is_last_look = links_.packets_ended.load(std::memory_order_acquire);
    if (solve_packet()) continue;
    if (is_last_look) break;
    wait();
  }
  if (const auto result = pipeline_.finish()) take(*result, last_arrived_mono_ns_);
  publish_status();  // with the packets since the last sweep
  watch_.end();
  links_.fixes_ended.store(true, std::memory_order_release);
  links_.fixes_bell.ring();
}

bool SolveLoop::solve_packet() noexcept {
  if (links_.packets.waiting(1) == 0) return false;
  const PacketHeader header = links_.packets.header();
  kernel_receive_.record(header.taken_mono_ns - header.arrived_mono_ns);
  ring_wait_.record(monotonic_ns() - header.taken_mono_ns);
  listen(header.receive_utc_ns);
  predict_until(header.receive_utc_ns);
  ++packets_of_sweep_;
  const auto result = pipeline_.process(links_.packets.front(), orders(header));
  links_.packets.free();
  if (!result) return true;
  packets_of_last_sweep_ = packets_of_sweep_;
  packets_of_sweep_ = 0;
  take(*result, header.arrived_mono_ns);
  return true;
}

/// A sweep that has come.
void SolveLoop::take(const SweepResult& result, std::int64_t arrived_mono_ns) noexcept {
  ++counters_.sweeps;
  if (result.skipped) ++counters_.sweeps_skipped;
  if (result.fix.match.out_of_time) ++counters_.deadline_misses;
  pass_on(result, arrived_mono_ns);
  if (links_.mode == EngineMode::fast_replay) pipeline_.search();
}

SweepOrders SolveLoop::orders(const PacketHeader& header) noexcept {
  if (links_.mode == EngineMode::fast_replay) return {};
  SweepOrders orders;
  // With more than a sweep waiting, this one's pose would be late, and make the next one's later still.
  orders.skip_match = packets_of_last_sweep_ != 0 &&
                      links_.packets.waiting(packets_of_last_sweep_ + 1) > packets_of_last_sweep_;
  if (deadline_ns_ != 0)
    orders.deadline = {.now_ns = monotonic_ns, .at_ns = header.arrived_mono_ns + deadline_ns_};
  return orders;
}

/// A log's frames come with the packets' times; a bus, which stamps its own, is asked a few times a sweep.
void SolveLoop::listen(std::int64_t now_utc_ns) noexcept {
  constexpr std::int64_t kPeriod_ns = 2'000'000;
  if (vehicle_bus_ == nullptr) return;
  if (links_.mode == EngineMode::live) {
    const std::int64_t now_ns = monotonic_ns();
    if (now_ns < listen_due_ns_) return;
    listen_due_ns_ = now_ns + kPeriod_ns;
    vehicle_bus_->maintain(now_ns);
  }
  pipeline_.listen(*vehicle_bus_, now_utc_ns);
}

void SolveLoop::predict_until(std::int64_t now_utc_ns) noexcept {
  while (const auto result = pipeline_.predict_missing(now_utc_ns)) {
    ++counters_.sweeps_missing;
    pass_on(*result, last_arrived_mono_ns_ + (result->fix.at.stamp_utc_ns - last_stamp_utc_ns_));
  }
}

void SolveLoop::wait() noexcept {
  // While packets come they wake it; this often a missing sweep is noticed.
  constexpr std::int64_t kLongest_ns = 10'000'000;
  if (links_.mode == EngineMode::live) {
    const std::int64_t now_utc_ns = utc_ns();
    listen(now_utc_ns);
    predict_until(now_utc_ns);
    if (counters_.sweeps == 0) say_that_none_came(now_utc_ns);
  }
  links_.packets_bell.wait(monotonic_ns() + kLongest_ns);
}

/// A sensor that has been silent from the start is NO_DATA too.
void SolveLoop::say_that_none_came(std::int64_t now_utc_ns) noexcept {
  constexpr std::int64_t kSilentAfter_ns = 1'000'000'000;
  constexpr std::int64_t kPeriod_ns = 500'000'000;
  const std::int64_t now_ns = monotonic_ns();
  if (silence_due_ns_ == 0) silence_due_ns_ = now_ns + kSilentAfter_ns;
  if (now_ns < silence_due_ns_) return;
  silence_due_ns_ = now_ns + kPeriod_ns;
  SweepResult result;
  result.missing = true;
  result.fix.state = ndt::State::no_data;
  result.fix.at.stamp_utc_ns = now_utc_ns;
  pass_on(result, now_ns);
}

template <class Ring>
void SolveLoop::push(Ring& ring, const SolvedSweep& sweep) noexcept {
  constexpr std::int64_t kALittle_ns = 50'000;
  while (!ring.push(sweep)) {
    if (links_.mode != EngineMode::fast_replay || links_.stop.load(std::memory_order_relaxed)) {
      ++counters_.fixes_dropped;
      return;
    }
    sleep_until(monotonic_ns() + kALittle_ns);
  }
}

void SolveLoop::pass_on(const SweepResult& result, std::int64_t arrived_mono_ns) noexcept {
  last_ = {.result = result, .arrived_mono_ns = arrived_mono_ns};
  last_stamp_utc_ns_ = result.fix.at.stamp_utc_ns;
  last_arrived_mono_ns_ = arrived_mono_ns;
  push(links_.fixes, last_);
  links_.fixes_bell.ring();
  push(links_.sweeps, last_);
  publish_status();
  watch_.look();
}

void SolveLoop::publish_status() noexcept {
  links_.status.back() = {.last = last_,
                          .counters = counters_,
                          .pipeline = pipeline_.counters(),
                          .stream = pipeline_.stream_counters(),
                          .odometry = pipeline_.odometry().status(),
                          .gnss = pipeline_.gnss().counters()};
  links_.status.publish();
}

}  // namespace landfix::platform
