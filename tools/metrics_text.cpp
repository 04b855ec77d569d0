#include "tools/metrics_text.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace landfix::tools {
namespace {

/// A label's value: quotes, backslashes and ends of line are the format's own.
[[nodiscard]] std::string label_of(std::string_view value) {
  std::string text;
  for (const char character : value) {
    if (character == '\n') {
      text += "\\n";
      continue;
    }
    if (character == '"' || character == '\\') text += '\\';
    text += character;
  }
  return text;
}

[[nodiscard]] std::string number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0.0 ? "+Inf" : "-Inf";
  return fmt::format("{:.10g}", value);
}

class Metrics {
 public:
  /// One family after the other; `name` without "landfix_".
  void family(std::string_view name, std::string_view type, std::string_view help) {
    name_ = fmt::format("landfix_{}", name);
    add("# HELP {} {}\n# TYPE {} {}\n", name_, help, name_, type);
  }
  void sample(double value) { add("{} {}\n", name_, number(value)); }
  void sample(std::uint64_t value) { add("{} {}\n", name_, value); }
  template <class Value>
  void sample(std::string_view label, std::string_view label_value, Value value) {
    add("{}{{{}=\"{}\"}} ", name_, label, label_of(label_value));
    if constexpr (std::is_floating_point_v<Value>)
      add("{}\n", number(value));
    else
      add("{}\n", value);
  }

  void gauge(std::string_view name, double value, std::string_view help) {
    family(name, "gauge", help);
    sample(value);
  }
  void counter(std::string_view name, std::uint64_t value, std::string_view help) {
    family(name, "counter", help);
    sample(value);
  }
  using Labelled = std::initializer_list<std::pair<std::string_view, std::uint64_t>>;
  void counters(std::string_view name, std::string_view label, Labelled values, std::string_view help) {
    family(name, "counter", help);
    for (const auto& [label_value, value] : values) sample(label, label_value, value);
  }

  /// Of the family "stage_duration_seconds".
  void histogram(std::string_view stage, const platform::DurationSummary& durations) {
    for (std::size_t i = 0; i < platform::kDurationBounds_s.size(); ++i) {
      add("{}_bucket{{stage=\"{}\",le=\"{}\"}} {}\n", name_, stage, number(platform::kDurationBounds_s[i]),
          durations.within[i]);
    }
    add("{}_bucket{{stage=\"{}\",le=\"+Inf\"}} {}\n", name_, stage, durations.count);
    add("{}_sum{{stage=\"{}\"}} {}\n", name_, stage, number(durations.sum_s));
    add("{}_count{{stage=\"{}\"}} {}\n", name_, stage, durations.count);
  }

  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    text_ += fmt::format(format, std::forward<Values>(values)...);
  }

  std::string text_;
  std::string name_;
};

void add_pose(Metrics& metrics, const platform::EngineStatus& status) {
  metrics.family("pose_state", "gauge", "1 for the state that the last pose has.");
  for (int i = 0; i <= static_cast<int>(ndt::State::tracking); ++i) {
    const auto state = static_cast<ndt::State>(i);
    metrics.sample("state", ndt::to_string(state), std::uint64_t{state == status.state ? 1U : 0U});
  }
  metrics.family("pose_sigma_meters", "gauge",
                 "Standard deviation of the position, level, by the vehicle's axes.");
  metrics.sample("axis", "along", status.sigma_along_m);
  metrics.sample("axis", "cross", status.sigma_cross_m);
  metrics.gauge("pose_sigma_yaw_radians", status.sigma_yaw_rad, "Standard deviation of the heading.");
  metrics.gauge("pose_stamp_seconds", 1e-9 * static_cast<double>(status.stamp_utc_ns),
                "Time that the last pose holds for, Unix.");
  metrics.gauge("speed_meters_per_second", status.speed_mps, "Speed of the vehicle.");
  metrics.gauge("ndt_iterations", status.iterations, "Iterations of the last match.");
  metrics.gauge("ndt_score_ratio", status.score,
                "Likelihood of the last match as a share of the best there can be.");
  metrics.gauge("scan_points", static_cast<double>(status.points),
                "Points of the last sweep after the filter.");
}

void add_counters(Metrics& metrics, const platform::EngineStatus& status) {
  metrics.family("packets_total", "counter", "Packets taken from the sensor.");
  metrics.sample("sensor", status.sensor, status.packets);
  metrics.counters("packets_dropped_total", "where",
                   {{"kernel", status.packets_dropped_kernel},
                    {"ring", status.packets_dropped_ring},
                    {"truncated", status.packets_truncated},
                    {"decode", status.packets_rejected}},
                   "Packets that came and were not used, by where they were dropped.");
  metrics.counter("packets_lost_total", status.packets_lost,
                  "Packets that the sensor sent and that never came.");
  metrics.counter("packets_foreign_total", status.packets_strangers,
                  "Packets of another sender than the sensor.");
  metrics.counter("receive_errors_total", status.receive_errors, "Calls to receive that the system refused.");
  metrics.counter("scans_total", status.sweeps, "Sweeps that came, whole or in part.");
  metrics.counter("scans_missing_total", status.sweeps_missing,
                  "Sweeps that did not come and were predicted.");
  metrics.counter("scans_skipped_total", status.sweeps_skipped,
                  "Sweeps that were not matched, as newer packets were waiting.");
  metrics.counter("deadline_misses_total", status.deadline_misses,
                  "Matches that were stopped by the deadline.");
  metrics.counter("fixes_dropped_total", status.fixes_dropped, "Poses that a thread had no room for.");
  metrics.counter("points_dropped_total", status.points_dropped, "Points that found no room.");
  metrics.counter("answers_late_total", status.answers_late,
                  "Answers of the search for a lost vehicle that were not there in time.");
  metrics.counter("clock_steps_total", status.clock_steps,
                  "Times that the sensor's or the receiver's clock was set.");
  metrics.counter("sensor_restarts_total", status.sensor_restarts, "Restarts of the sensor.");
  metrics.counter("can_tx_frames_total", status.bus.frames_sent, "Frames that the bus took.");
  metrics.counters("can_tx_dropped_total", "reason",
                   {{"queue_full", status.bus.dropped_queue_full}, {"bus_down", status.bus.dropped_bus_down}},
                   "Frames that the bus did not take.");
  metrics.family("can_state", "gauge", "1 for the state that the bus has.");
  for (std::size_t i = 0; i < platform::kBusStates; ++i) {
    const auto state = static_cast<platform::BusState>(i);
    metrics.sample("state", platform::to_string(state), std::uint64_t{state == status.bus.state ? 1U : 0U});
  }
  metrics.counter("can_saturated_total", status.poses_saturated, "Poses beyond what their frames can say.");
}

void add_vehicle_bus(Metrics& metrics, const platform::EngineStatus& status) {
  const platform::OdometryStatus& odometry = status.odometry;
  metrics.counter("odometry_samples_total", odometry.counters.samples,
                  "Samples of odometry that were taken.");
  metrics.counter("odometry_left_out_total", odometry.counters.times_left_out,
                  "Times that odometry disagreed with the LiDAR and was left out.");
  metrics.family("odometry_believed", "gauge", "1 while odometry agrees with the LiDAR and is used.");
  metrics.sample("quantity", "speed", std::uint64_t{odometry.is_speed_believed ? 1U : 0U});
  metrics.sample("quantity", "yaw_rate", std::uint64_t{odometry.is_yaw_rate_believed ? 1U : 0U});
  metrics.counter("gnss_guesses_total", status.gnss.guesses, "Sweeps that were looked for where GNSS says.");
}

void add_process(Metrics& metrics, const platform::EngineStatus& status) {
  metrics.family("page_faults_total", "counter", "Page faults of a thread since it was ready.");
  for (const platform::ThreadStatus& thread : status.threads) {
    metrics.sample("thread", thread.name, thread.page_faults);
  }
  if (status.heap_is_counted) {
    metrics.family("heap_allocations_total", "counter", "Heap calls of a thread since it was ready.");
    for (const platform::ThreadStatus& thread : status.threads) {
      metrics.sample("thread", thread.name, thread.heap_calls);
    }
  }
  metrics.family("thread_alive", "gauge", "1 while the thread advances.");
  for (const platform::ThreadStatus& thread : status.threads) {
    metrics.sample("thread", thread.name, std::uint64_t{thread.advances ? 1U : 0U});
  }
  metrics.gauge("uptime_seconds", status.uptime_s, "Time since the start.");
  metrics.gauge("resident_memory_bytes", static_cast<double>(status.resident_bytes),
                "Memory that the process holds.");
  metrics.family("build_info", "gauge", "1, with the version.");
  metrics.sample("version", status.version, std::uint64_t{1});
}

}  // namespace

std::string to_prometheus(const platform::EngineStatus& status) {
  Metrics metrics;
  add_pose(metrics, status);
  add_counters(metrics, status);
  add_vehicle_bus(metrics, status);
  metrics.family("stage_duration_seconds", "histogram", "What a pose's time is spent on.");
  for (std::size_t i = 0; i < platform::kStageCount; ++i) {
    metrics.histogram(to_string(static_cast<platform::Stage>(i)), status.stages[i]);
  }
  add_process(metrics, status);
  return metrics.take();
}

}  // namespace landfix::tools
