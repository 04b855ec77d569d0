#include "tools/replay_report.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>

#include "tools/decode_report.hpp"
#include "tools/evaluation_report.hpp"

namespace landfix::tools {
namespace {

/// The most memory that the process has held.
[[nodiscard]] double peak_resident_mib() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Whose clock the stamps come from, at the end of the drive.
[[nodiscard]] std::string_view time_source(const ReplayResult& result) {
  return result.sweeps.empty() ? "none" : to_string(result.sweeps.back().time_source);
}

struct StageTimes {
  std::string name;
  double p50_ms = 0.0;
  double p99_ms = 0.0;
  double max_ms = 0.0;
};

[[nodiscard]] std::vector<StageTimes> stage_times(const platform::Pipeline& pipeline) {
  const auto to_ms = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-6; };
  std::vector<StageTimes> stages;
  for (std::size_t i = 0; i < platform::kStageCount; ++i) {
    const auto stage = static_cast<platform::Stage>(i);
    const platform::LatencyHistogram& durations = pipeline.durations(stage);
    stages.push_back({std::string(to_string(stage)), to_ms(durations.percentile_ns(50.0)),
                      to_ms(durations.percentile_ns(99.0)), to_ms(durations.max_ns())});
  }
  return stages;
}

}  // namespace

nlohmann::ordered_json to_json(const ReplayReport& report) {
  const ReplayResult& result = report.result;
  const platform::PipelineCounters& counters = report.pipeline.counters();
  const drivers::StreamCounters& stream = report.pipeline.stream_counters();
  nlohmann::ordered_json stages;
  for (const StageTimes& stage : stage_times(report.pipeline)) {
    stages[stage.name] = {{"p50", stage.p50_ms}, {"p99", stage.p99_ms}, {"max", stage.max_ms}};
  }
  nlohmann::ordered_json object;
  object["sweeps"] = result.sweeps.size() - result.missing();
  object["missing"] = result.missing();
  object["poses"] = result.trajectory().size();
  object["tracked"] = result.count(ndt::State::tracking);
  object["lost"] = result.count(ndt::State::lost);
  object["partial"] = result.partial();
  object["time_source"] = time_source(result);
  object["packets"] = {{"total", counters.packets},
                       {"rejected", counters.rejected()},
                       {"lost", stream.lost_packets},
                       {"dropped", 0},  // a replay reads as fast as it solves
                       {"other_senders", counters.other_senders},
                       {"other_ports", counters.other_ports}};
  object["points_dropped"] = {{"sweep_full", counters.points_overflowed},
                              {"filter_full_or_not_finite", counters.points_unfiltered}};
  object["pairs_dropped"] = counters.pairs_dropped;
  object["clock_steps"] = stream.clock_steps;
  object["restarts"] = stream.restarts;
  if (const auto odometry = report.pipeline.odometry().counters(); odometry.frames != 0) {
    object["odometry"] = {{"frames", odometry.frames},
                          {"samples", odometry.samples},
                          {"invalid", odometry.invalid},
                          {"jumps", odometry.jumps},
                          {"silent", odometry.silent},
                          {"times_left_out", odometry.times_left_out},
                          {"speed_believed", report.pipeline.odometry().speed().is_believed()},
                          {"yaw_rate_believed", report.pipeline.odometry().yaw_rate().is_believed()}};
  }
  object["can_frames"] = {{"dropped", counters.frames_dropped}, {"saturated", counters.frames_saturated}};
  object["points_mean"] = result.points_mean();
  object["iterations_mean"] = result.iterations_mean();
  object["latency_ms"] = nullptr;
  object["stage_ms"] = stages;
  object["heap_calls"] =
      result.heap_calls ? nlohmann::ordered_json(*result.heap_calls) : nlohmann::ordered_json();
  object["page_faults"] = result.page_faults;
  object["rss_mib"] = peak_resident_mib();
  object["truncated"] = result.truncated;
  if (report.evaluation) object["evaluation"] = to_json(*report.evaluation);
  if (report.covariances) {
    const CovarianceCheck& check = *report.covariances;
    object["nees"] = {{"sweeps", check.sweeps},    {"mean", check.per_degree_of_freedom},
                      {"x", check.by_axis[0]},     {"y", check.by_axis[1]},
                      {"z", check.by_axis[2]},     {"roll", check.by_axis[3]},
                      {"pitch", check.by_axis[4]}, {"yaw", check.by_axis[5]}};
  }
  return object;
}

std::string to_text(const ReplayReport& report) {
  const ReplayResult& result = report.result;
  const platform::PipelineCounters& counters = report.pipeline.counters();
  const drivers::StreamCounters& stream = report.pipeline.stream_counters();
  const auto count = [&result](ndt::State state) { return result.count(state); };
  std::string text = fmt::format(
      "sweeps       {}, and {} missing: {} tracking, {} degraded, {} predicted, {} lost, {} without data, "
      "{} before the first match\n"
      "             {} partial; stamps by the {} clock\n"
      "packets      {}, {} rejected, {} lost; {} from other senders, {} to other ports\n"
      "iterations   {:.2f} a sweep on average\n",
      result.sweeps.size() - result.missing(), result.missing(), count(ndt::State::tracking),
      count(ndt::State::degraded), count(ndt::State::predicted), count(ndt::State::lost),
      count(ndt::State::no_data), count(ndt::State::init), result.partial(), time_source(result),
      counters.packets, counters.rejected(), stream.lost_packets, counters.other_senders,
      counters.other_ports, result.iterations_mean());
  for (const auto& [reason, packets] : rejections(counters.by_status)) {
    text += fmt::format("  rejected   {}: {}\n", packets, reason);
  }
  if (stream.clock_steps != 0) text += fmt::format("             {} steps of a clock\n", stream.clock_steps);
  if (stream.restarts != 0) text += fmt::format("             {} restarts of the sensor\n", stream.restarts);
  const std::array<std::pair<std::uint64_t, std::string_view>, 5> losses{
      {{counters.points_overflowed, "points that did not fit the sweep"},
       {counters.points_unfiltered, "points that did not fit the filter, or were not finite"},
       {counters.pairs_dropped, "pairs of a point and a voxel that did not fit the matcher"},
       {counters.frames_dropped, "CAN frames that could not be written"},
       {counters.frames_saturated, "poses beyond what their CAN frames can say"}}};
  for (const auto& [lost, what] : losses) {
    if (lost != 0) text += fmt::format("dropped      {} {}\n", lost, what);
  }
  if (const auto odometry = report.pipeline.odometry().counters(); odometry.frames != 0) {
    text += fmt::format(
        "odometry     {} frames, {} samples; {} values invalid, {} jumps, silent during {} sweeps, left out "
        "{} "
        "times\n             at the end the speed is {}, the yaw rate {}\n",
        odometry.frames, odometry.samples, odometry.invalid, odometry.jumps, odometry.silent,
        odometry.times_left_out, report.pipeline.odometry().speed().is_believed() ? "believed" : "left out",
        report.pipeline.odometry().yaw_rate().is_believed() ? "believed" : "left out");
  }
  text += "time a sweep [ms]    p50      p99      max\n";
  for (const StageTimes& stage : stage_times(report.pipeline)) {
    text += fmt::format("  {:<12} {:8.3f} {:8.3f} {:8.3f}\n", stage.name, stage.p50_ms, stage.p99_ms,
                        stage.max_ms);
  }
  text += fmt::format("heap calls   {}, page faults {}, resident memory {:.0f} MiB at most\n",
                      result.heap_calls ? std::to_string(*result.heap_calls) : "not counted",
                      result.page_faults, peak_resident_mib());
  if (result.truncated) text += "the capture ends in the middle of a record: it has been cut short\n";
  if (report.evaluation) text += to_table(*report.evaluation);
  if (report.covariances) {
    text += fmt::format("covariance   squared errors are {:.2f} times what it says\n",
                        report.covariances->per_degree_of_freedom);
  }
  return text;
}

}  // namespace landfix::tools
