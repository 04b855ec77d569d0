#include "tools/status_json.hpp"

#include <string>

#include "tools/decode_report.hpp"
#include "tools/input_files.hpp"
#include "tools/latency_table.hpp"

namespace landfix::tools {

nlohmann::ordered_json to_json(const platform::EngineStatus& status) {
  using nlohmann::ordered_json;
  ordered_json object;
  object["version"] = status.version;
  object["sensor"] = status.sensor;
  object["uptime_s"] = status.uptime_s;
  object["rss_mib"] = static_cast<double>(status.resident_bytes) / (1 << 20);
  object["state"] = ndt::to_string(status.state);
  object["stamp_utc_ns"] = status.stamp_utc_ns;
  object["time_source"] = to_string(status.time_source);
  object["pose"] = pose_to_json(status.pose);
  object["speed_mps"] = status.speed_mps;
  object["sigma_m"] = {{"along", status.sigma_along_m}, {"cross", status.sigma_cross_m}};
  object["sigma_yaw_deg"] = status.sigma_yaw_rad / kRadians_per_deg;
  object["score"] = status.score;
  object["iterations"] = status.iterations;
  object["points"] = status.points;
  object["packets"] = {{"total", status.packets},
                       {"dropped_kernel", status.packets_dropped_kernel},
                       {"dropped_ring", status.packets_dropped_ring},
                       {"truncated", status.packets_truncated},
                       {"rejected", status.packets_rejected},
                       {"lost", status.packets_lost},
                       {"strangers", status.packets_strangers},
                       {"receive_errors", status.receive_errors}};
  object["sweeps"] = {{"total", status.sweeps},
                      {"missing", status.sweeps_missing},
                      {"skipped", status.sweeps_skipped},
                      {"deadline_misses", status.deadline_misses}};
  object["fixes_dropped"] = status.fixes_dropped;
  object["points_dropped"] = status.points_dropped;
  object["answers_late"] = status.answers_late;
  object["clock_steps"] = status.clock_steps;
  object["restarts"] = status.sensor_restarts;
  const platform::OdometryStatus& odometry = status.odometry;
  object["odometry"] = {{"frames", odometry.counters.frames},
                        {"samples", odometry.counters.samples},
                        {"jumps", odometry.counters.jumps},
                        {"silent", odometry.counters.silent},
                        {"times_left_out", odometry.counters.times_left_out},
                        {"speed_believed", odometry.is_speed_believed},
                        {"yaw_rate_believed", odometry.is_yaw_rate_believed}};
  object["gnss"] = {
      {"frames", status.gnss.frames}, {"invalid", status.gnss.invalid}, {"guesses", status.gnss.guesses}};
  object["can"] = {{"state", platform::to_string(status.bus.state)},
                   {"frames", status.bus.frames_sent},
                   {"dropped_queue_full", status.bus.dropped_queue_full},
                   {"dropped_bus_down", status.bus.dropped_bus_down},
                   {"times_lost", status.bus.times_lost},
                   {"saturated", status.poses_saturated}};
  ordered_json& stages = object["stage_ms"] = ordered_json::object();
  for (std::size_t i = 0; i < platform::kStageCount; ++i) {
    const platform::DurationSummary& durations = status.stages[i];
    if (durations.count == 0) continue;
    ordered_json stage{{"count", durations.count}};
    for (std::size_t k = 0; k < durations.percentiles_s.size(); ++k) {
      stage[std::string(kLatencyKeys[k])] = 1e3 * durations.percentiles_s[k];
    }
    stage[std::string(kLatencyKeys.back())] = 1e3 * durations.max_s;
    stages[std::string(platform::kStageNames[i])] = stage;
  }
  ordered_json& threads = object["threads"] = ordered_json::array();
  for (const platform::ThreadStatus& thread : status.threads) {
    threads.push_back(
        {{"name", thread.name},
         {"alive", thread.advances},
         {"page_faults", thread.page_faults},
         {"heap_calls", status.heap_is_counted ? ordered_json(thread.heap_calls) : ordered_json()}});
  }
  return object;
}

}  // namespace landfix::tools
