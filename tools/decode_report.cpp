#include "tools/decode_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace landfix::tools {
using drivers::DecodeStatus;

std::vector<std::pair<std::string_view, std::uint64_t>> rejections(const drivers::StatusCounts& packets) {
  std::vector<std::pair<std::string_view, std::uint64_t>> all;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const auto status = static_cast<DecodeStatus>(i);
    if (packets[i] != 0 && drivers::is_rejected(status)) all.emplace_back(to_string(status), packets[i]);
  }
  return all;
}

std::string reasons(const DecodeSummary& summary) {
  std::vector<std::string> counted;
  for (const auto& [reason, count] : rejections(summary.packets)) {
    counted.push_back(fmt::format("{} x {}", count, reason));
  }
  return fmt::format("{}", fmt::join(counted, ", "));
}

namespace {

nlohmann::json position_of(const DecodeSummary& summary) {
  if (!summary.position) return nullptr;
  return {{"latitude_deg", summary.position->latitude_deg},
          {"longitude_deg", summary.position->longitude_deg},
          {"valid", summary.position_is_valid}};
}

}  // namespace

void print_json(const drivers::SensorModel& model, const DecodeSummary& summary) {
  nlohmann::json sweeps = nlohmann::json::array();
  for (const SweepSummary& sweep : summary.sweeps) {
    sweeps.push_back({{"index", sweeps.size()},
                      {"points", sweep.points},
                      {"points_dropped", sweep.overflowed},
                      {"packets_lost", sweep.lost_packets},
                      {"complete", sweep.complete},
                      {"time_source", to_string(sweep.time_source)},
                      {"first_time", sweep.first_time_s},
                      {"last_time", sweep.last_time_s}});
  }
  nlohmann::json reasons = nlohmann::json::object();
  for (const auto& [reason, count] : rejections(summary.packets)) reasons[std::string(reason)] = count;
  const nlohmann::json object{{"sensor", model.name},
                              {"packets",
                               {{"total", summary.decoded() + summary.rejected()},
                                {"decoded", summary.decoded()},
                                {"rejected", summary.rejected()},
                                {"reasons", reasons},
                                {"telemetry", summary.of(DecodeStatus::telemetry)},
                                {"lost", summary.stream.lost_packets},
                                {"other_ports", summary.elsewhere}}},
                              {"clock_steps", summary.stream.clock_steps},
                              {"restarts", summary.stream.restarts},
                              {"position", position_of(summary)},
                              {"sweeps", sweeps}};
  fmt::print("{}\n", object.dump(2));
}

void print_text(const drivers::SensorModel& model, const DecodeSummary& summary, const std::string& folder) {
  fmt::print("{}: {} packets decoded, {} rejected, {} lost, {} of telemetry, {} to other ports\n",
             model.display_name, summary.decoded(), summary.rejected(), summary.stream.lost_packets,
             summary.of(DecodeStatus::telemetry), summary.elsewhere);
  for (const auto& [reason, count] : rejections(summary.packets))
    fmt::print("  rejected {}: {}\n", count, reason);
  if (summary.stream.clock_steps != 0) fmt::print("  {} steps of a clock\n", summary.stream.clock_steps);
  if (summary.stream.restarts != 0) fmt::print("  {} restarts of the sensor\n", summary.stream.restarts);
  if (summary.position) {
    fmt::print("  last position of the receiver at the sensor: {:.6f}, {:.6f} deg{}\n",
               summary.position->latitude_deg, summary.position->longitude_deg,
               summary.position_is_valid ? "" : "; it lost its fix later");
  }
  std::size_t complete = 0;
  for (std::size_t i = 0; i < summary.sweeps.size(); ++i) {
    const SweepSummary& sweep = summary.sweeps[i];
    fmt::print("  {:04}  {:>7} points  {:.6f} to {:.6f}  {} time{}{}{}\n", i, sweep.points,
               sweep.first_time_s, sweep.last_time_s, to_string(sweep.time_source),
               sweep.complete ? "" : "  partial",
               sweep.lost_packets == 0 ? "" : fmt::format("  {} packets lost", sweep.lost_packets),
               sweep.overflowed == 0 ? "" : fmt::format("  {} points did not fit", sweep.overflowed));
    complete += sweep.complete ? 1 : 0;
  }
  fmt::print("{} sweeps, {} complete, in {}\n", summary.sweeps.size(), complete, folder);
}

}  // namespace landfix::tools
