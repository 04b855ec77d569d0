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

[[nodiscard]] double to_ms(std::int64_t ns) { return static_cast<double>(ns) * 1e-6; }

struct StageTimes {
  std::string name;
  double p50_ms = 0.0;
  double p99_ms = 0.0;
  double max_ms = 0.0;
};

[[nodiscard]] std::vector<StageTimes> stage_times(const ReplayResult& result) {
  std::vector<StageTimes> stages;
  for (std::size_t i = 0; i < platform::kStageCount; ++i) {
    const auto stage = static_cast<platform::Stage>(i);
    const platform::LatencyHistogram& durations = result.duration(stage);
    if (durations.count() == 0) continue;  // not of this kind of replay
    stages.push_back({std::string(to_string(stage)), to_ms(durations.percentile_ns(50.0)),
                      to_ms(durations.percentile_ns(99.0)), to_ms(durations.max_ns())});
  }
  return stages;
}

/// Null where there was no pace to be late against.
[[nodiscard]] nlohmann::ordered_json latency_ms(const platform::LatencyHistogram& total) {
  if (total.count() == 0) return nullptr;
  return {{"p50", to_ms(total.percentile_ns(50.0))},
          {"p99", to_ms(total.percentile_ns(99.0))},
          {"p999", to_ms(total.percentile_ns(99.9))},
          {"max", to_ms(total.max_ns())}};
}

[[nodiscard]] std::string or_not_counted(const std::optional<std::uint64_t>& count) {
  return count ? std::to_string(*count) : "not counted";
}

[[nodiscard]] nlohmann::ordered_json or_null(const std::optional<std::uint64_t>& count) {
  return count ? nlohmann::ordered_json(*count) : nlohmann::ordered_json();
}

}  // namespace

nlohmann::ordered_json to_json(const ReplayReport& report) {
  const ReplayResult& result = report.result;
  const platform::PipelineCounters& counters = report.result.pipeline;
  const drivers::StreamCounters& stream = report.result.stream;
  nlohmann::ordered_json stages;
  for (const StageTimes& stage : stage_times(report.result)) {
    stages[stage.name] = {{"p50", stage.p50_ms}, {"p99", stage.p99_ms}, {"max", stage.max_ms}};
  }
  nlohmann::ordered_json object;
  object["sweeps"] = result.tally.came();
  object["missing"] = result.tally.missing();
  object["poses"] = result.trajectory().size();
  object["tracked"] = result.tally.count(ndt::State::tracking);
  object["lost"] = result.tally.count(ndt::State::lost);
  object["partial"] = result.tally.partial();
  object["time_source"] = to_string(result.tally.time_source());
  object["packets"] = {{"total", counters.packets},
                       {"rejected", counters.rejected()},
                       {"lost", stream.lost_packets},
                       {"dropped", result.packets_dropped},
                       {"other_senders", counters.other_senders},
                       {"other_ports", counters.other_ports}};
  object["points_dropped"] = {{"sweep_full", counters.points_overflowed},
                              {"filter_full_or_not_finite", counters.points_unfiltered}};
  object["pairs_dropped"] = counters.pairs_dropped;
  object["answers_late"] = counters.answers_late;
  object["clock_steps"] = stream.clock_steps;
  object["restarts"] = stream.restarts;
  if (const platform::GnssCounters& gnss = result.gnss; gnss.frames != 0) {
    object["gnss"] = {{"frames", gnss.frames}, {"invalid", gnss.invalid}, {"guesses", gnss.guesses}};
  }
  if (const platform::OdometryStatus& odometry = result.odometry; odometry.counters.frames != 0) {
    object["odometry"] = {
        {"frames", odometry.counters.frames},           {"samples", odometry.counters.samples},
        {"invalid", odometry.counters.invalid},         {"jumps", odometry.counters.jumps},
        {"silent", odometry.counters.silent},           {"times_left_out", odometry.counters.times_left_out},
        {"speed_believed", odometry.is_speed_believed}, {"yaw_rate_believed", odometry.is_yaw_rate_believed}};
  }
  object["can_frames"] = {{"dropped", result.frames_dropped}, {"saturated", result.poses_saturated}};
  object["points_mean"] = result.tally.points_mean();
  object["iterations_mean"] = result.tally.iterations_mean();
  object["sweeps_skipped"] = result.sweeps_skipped;
  object["deadline_misses"] = result.deadline_misses;
  object["latency_ms"] = latency_ms(result.duration(platform::Stage::total));
  object["stage_ms"] = stages;
  object["heap_calls"] = or_null(result.heap_calls);
  object["locks"] = or_null(result.locks);
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
  const platform::PipelineCounters& counters = report.result.pipeline;
  const drivers::StreamCounters& stream = report.result.stream;
  const auto count = [&result](ndt::State state) { return result.tally.count(state); };
  std::string text = fmt::format(
      "sweeps       {}, and {} missing: {} tracking, {} degraded, {} predicted, {} lost, {} without data, "
      "{} before the first match\n"
      "             {} partial; stamps by the {} clock\n"
      "packets      {}, {} rejected, {} lost; {} from other senders, {} to other ports\n"
      "iterations   {:.2f} a sweep on average\n",
      result.tally.came(), result.tally.missing(), count(ndt::State::tracking), count(ndt::State::degraded),
      count(ndt::State::predicted), count(ndt::State::lost), count(ndt::State::no_data),
      count(ndt::State::init), result.tally.partial(), to_string(result.tally.time_source()),
      counters.packets, counters.rejected(), stream.lost_packets, counters.other_senders,
      counters.other_ports, result.tally.iterations_mean());
  for (const auto& [reason, packets] : rejections(counters.by_status)) {
    text += fmt::format("  rejected   {}: {}\n", packets, reason);
  }
  if (counters.answers_late != 0) {
    text += fmt::format("             {} answers of the search for a lost vehicle were late\n",
                        counters.answers_late);
  }
  if (stream.clock_steps != 0) text += fmt::format("             {} steps of a clock\n", stream.clock_steps);
  if (stream.restarts != 0) text += fmt::format("             {} restarts of the sensor\n", stream.restarts);
  const std::array<std::pair<std::uint64_t, std::string_view>, 9> losses{
      {{result.packets_dropped, "packets that found the ring full"},
       {result.sweeps_skipped, "sweeps that were predicted, not matched, as newer packets were waiting"},
       {result.deadline_misses, "matches that were stopped at the deadline"},
       {result.results_dropped, "poses that found no room between the threads"},
       {counters.points_overflowed, "points that did not fit the sweep"},
       {counters.points_unfiltered, "points that did not fit the filter, or were not finite"},
       {counters.pairs_dropped, "pairs of a point and a voxel that did not fit the matcher"},
       {result.frames_dropped, "CAN frames that could not be written"},
       {result.poses_saturated, "poses beyond what their CAN frames can say"}}};
  for (const auto& [lost, what] : losses) {
    if (lost != 0) text += fmt::format("dropped      {} {}\n", lost, what);
  }
  if (const platform::GnssCounters& gnss = result.gnss; gnss.frames != 0) {
    fmt::print("gnss         {} frames, {} values invalid; looked for {} sweeps where it says\n", gnss.frames,
               gnss.invalid, gnss.guesses);
  }
  if (const platform::OdometryStatus& odometry = result.odometry; odometry.counters.frames != 0) {
    const auto verdict = [](bool is_believed) { return is_believed ? "believed" : "left out"; };
    text += fmt::format(
        "odometry     {} frames, {} samples; {} values invalid, {} jumps, silent during {} sweeps, left out "
        "{} times\n"
        "             at the end the speed is {}, the yaw rate {}\n",
        odometry.counters.frames, odometry.counters.samples, odometry.counters.invalid,
        odometry.counters.jumps, odometry.counters.silent, odometry.counters.times_left_out,
        verdict(odometry.is_speed_believed), verdict(odometry.is_yaw_rate_believed));
  }
  text += "time a sweep [ms]    p50      p99      max\n";
  for (const StageTimes& stage : stage_times(report.result)) {
    text += fmt::format("  {:<12} {:8.3f} {:8.3f} {:8.3f}\n", stage.name, stage.p50_ms, stage.p99_ms,
                        stage.max_ms);
  }
  text += fmt::format("heap calls   {}, locks {}, page faults {}, resident memory {:.0f} MiB at most\n",
                      or_not_counted(result.heap_calls), or_not_counted(result.locks), result.page_faults,
                      peak_resident_mib());
  if (result.truncated) text += "the capture ends in the middle of a record: it has been cut short\n";
  if (report.evaluation) text += to_table(*report.evaluation);
  if (report.covariances) {
    text += fmt::format("covariance   squared errors are {:.2f} times what it says\n",
                        report.covariances->per_degree_of_freedom);
  }
  return text;
}

}  // namespace landfix::tools
