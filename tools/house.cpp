#include "tools/house.hpp"

#include <array>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include "platform/bus_message.hpp"
#include "platform/nanoseconds.hpp"
#include "platform/watchdog.hpp"
#include "tools/journal.hpp"

namespace landfix::tools {
namespace {

constexpr std::int64_t kSavePeriod_ns = 10 * platform::kNs_per_s;
constexpr std::int64_t kStatusPeriod_ns = 2 * platform::kNs_per_s;
constexpr std::int64_t kSnapshotPeriod_ns = platform::kNs_per_s / 2;

}  // namespace

void House::turn(std::int64_t now_mono_ns) {
  while (const auto sweep = engine_.next_sweep()) take(*sweep);
  while (engine_.next_sent()) continue;
  watch(now_mono_ns);
  say_of_bus();
  if (metrics_ != nullptr && now_mono_ns >= snapshot_due_ns_) {
    metrics_->publish(snapshot(view_, now_mono_ns));
    snapshot_due_ns_ = now_mono_ns + kSnapshotPeriod_ns;
  }
  if (now_mono_ns >= status_due_ns_) {
    notifier_.status(status_line());
    status_due_ns_ = now_mono_ns + kStatusPeriod_ns;
  }
  if (now_mono_ns >= save_due_ns_) {
    save();
    save_due_ns_ = now_mono_ns + kSavePeriod_ns;
  }
}

void House::close() {
  while (const auto sweep = engine_.next_sweep()) take(*sweep);
  save();
  log_line(Severity::info, status_line());
}

void House::take(const platform::SolvedSweep& sweep) {
  const ndt::Fix& fix = sweep.result.fix;
  if (fix.state == ndt::State::tracking) last_good_ = fix.at;
  if (fix.state == state_) return;
  const Eigen::Vector3d& place_m = fix.at.pose.translation();
  const bool is_worse = fix.state < state_;
  log_line(is_worse ? Severity::warning : Severity::info,
           fmt::format("{} -> {} at {:.2f} {:.2f} {:.2f}", ndt::to_string(state_), ndt::to_string(fix.state),
                       place_m.x(), place_m.y(), place_m.z()));
  state_ = fix.state;
}

void House::watch(std::int64_t now_mono_ns) {
  const auto threads = engine_.threads();
  std::array<platform::WatchedThread, threads.size()> watched;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    watched[i] = {.name = threads[i].name,
                  .budget_ns = view_.thread_budget_ns,
                  .heartbeat = &threads[i].watch->heartbeat()};
  }
  const platform::WatchedThread* const late = platform::find_late(watched, now_mono_ns);
  if (late != nullptr && !was_late_) {
    log_line(Severity::error,
             fmt::format("thread {} has not come round for {:.1f} s", late->name,
                         static_cast<double>(now_mono_ns - late->heartbeat->marked_ns()) * 1e-9));
  }
  was_late_ = late != nullptr;
  const auto alive_period_ns = notifier_.alive_period_ns();
  if (was_late_ || !alive_period_ns || now_mono_ns < alive_due_ns_) return;
  notifier_.alive();
  alive_due_ns_ = now_mono_ns + *alive_period_ns / 2;
}

void House::say_of_bus() {
  const platform::BusStatus bus = view_.bus.status();
  if (bus.state == std::exchange(bus_, bus.state)) return;
  log_line(bus.state == platform::BusState::up ? Severity::info : Severity::warning,
           platform::describe_bus(settings_.interface, bus.state, bus.error));
}

/// A disk that is full costs a warning, once, and no pose.
void House::save() {
  if (settings_.resume.empty() || !last_good_) return;
  try {
    platform::save_pose(settings_.resume, {.at = *last_good_, .map_checksum = settings_.map_checksum});
    last_good_.reset();
    could_save_ = true;
  } catch (const std::exception& error) {
    if (could_save_) log_line(Severity::warning, fmt::format("the last pose is not kept: {}", error.what()));
    could_save_ = false;
  }
}

std::string House::status_line() {
  const platform::SolveStatus& status = engine_.solve_status();
  return fmt::format("{}; {} sweeps, {} missing, {} skipped, {} packets, {} rejected", ndt::to_string(state_),
                     status.counters.sweeps, status.counters.sweeps_missing, status.counters.sweeps_skipped,
                     status.pipeline.packets, status.pipeline.rejected());
}

}  // namespace landfix::tools
