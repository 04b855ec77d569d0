#include "tools/benchmark_report.hpp"

#include <vector>

#include <fmt/format.h>

namespace landfix::tools {
namespace {

[[nodiscard]] nlohmann::json times_to_json(const std::vector<double>& cpu_ms) {
  return {{"median", quantile(cpu_ms, 0.5)}, {"p99", quantile(cpu_ms, 0.99)}};
}

/// How unsteady the time of a match is.
[[nodiscard]] double p99_to_median(const std::vector<double>& cpu_ms) {
  return quantile(cpu_ms, 0.99) / quantile(cpu_ms, 0.5);
}

[[nodiscard]] nlohmann::json performance_to_json(const Performance& performance) {
  const Summary summary = summarise(performance.samples);
  nlohmann::json match = times_to_json(performance.match_cpu_ms);
  match["p99_to_median"] = p99_to_median(performance.match_cpu_ms);
  return {{"starts", performance.samples.size()},
          {"points_mean", performance.points_mean},
          {"ok_percent", summary.ok_percent},
          {"error_cm", {{"median", summary.error_median_cm}, {"p95", summary.error_p95_cm}}},
          {"error_deg", {{"median", summary.error_median_deg}, {"p95", summary.error_p95_deg}}},
          {"bias_cm", {{"all", summary.bias_cm}, {"ok", summary.bias_ok_cm}}},
          {"iterations_mean", summary.iterations_mean},
          {"filter_cpu_ms", times_to_json(performance.filter_cpu_ms)},
          {"match_cpu_ms", match},
          {"map", {{"build_ms", quantile(performance.build_cpu_ms, 0.5)}}}};
}

[[nodiscard]] std::string performance_to_text(const Performance& performance) {
  const Summary summary = summarise(performance.samples);
  return fmt::format(
      "ok           {:.2f} % (within 10 cm and 0.5 deg of the truth)\n"
      "error        median {:.2f} cm, {:.3f} deg; p95 {:.2f} cm, {:.3f} deg\n"
      "bias         {:.2f} cm; {:.2f} cm of those that are ok\n"
      "iterations   {:.2f} on average\n"
      "filter       median {:.3f} ms, p99 {:.3f} ms of CPU; leaves {:.0f} points on average\n"
      "match        median {:.3f} ms, p99 {:.3f} ms of CPU: {:.2f} times the median\n",
      summary.ok_percent, summary.error_median_cm, summary.error_median_deg, summary.error_p95_cm,
      summary.error_p95_deg, summary.bias_cm, summary.bias_ok_cm, summary.iterations_mean,
      quantile(performance.filter_cpu_ms, 0.5), quantile(performance.filter_cpu_ms, 0.99),
      performance.points_mean, quantile(performance.match_cpu_ms, 0.5),
      quantile(performance.match_cpu_ms, 0.99), p99_to_median(performance.match_cpu_ms));
}

[[nodiscard]] double bytes_per_voxel(const BenchmarkReport& report) {
  return static_cast<double>(report.map_bytes) / static_cast<double>(report.map_voxels);
}

}  // namespace

nlohmann::json to_json(const BenchmarkReport& report) {
  const BenchmarkResult& result = report.result;
  nlohmann::json json = performance_to_json(result.ours);
  json["scans"] = result.scans;
  json["map"].update({{"voxels", report.map_voxels},
                      {"bytes", report.map_bytes},
                      {"bytes_per_voxel", bytes_per_voxel(report)},
                      {"read_ms", report.map_read_ms ? nlohmann::json(*report.map_read_ms) : nullptr}});
  if (report.rival_name) {
    json["rival"] = performance_to_json(result.rival);
    json["rival"]["name"] = *report.rival_name;
    json["ratio"] = {{"match", quantile(result.ratios.match, 0.5)},
                     {"filter", quantile(result.ratios.filter, 0.5)},
                     {"build", quantile(result.ratios.build, 0.5)}};
  }
  return json;
}

std::string to_text(const BenchmarkReport& report) {
  const BenchmarkResult& result = report.result;
  std::string text = fmt::format(
      "scans        {}, {} starts\n{}map          {} voxels, {} bytes, {:.1f} a voxel{}\n", result.scans,
      result.ours.samples.size(), performance_to_text(result.ours), report.map_voxels, report.map_bytes,
      bytes_per_voxel(report),
      report.map_read_ms ? fmt::format("; read in {:.1f} ms, built in {:.1f} ms", *report.map_read_ms,
                                       quantile(result.ours.build_cpu_ms, 0.5))
                         : "");
  if (report.rival_name) {
    text += fmt::format(
        "\n{}, {} of these starts\n{}map          built in {:.1f} ms\n"
        "\nlandfix takes less by a factor of (median of the pairs)\n"
        "match        {:.1f}\nfilter       {:.1f}\nmap build    {:.1f}\n",
        *report.rival_name, result.rival.samples.size(), performance_to_text(result.rival),
        quantile(result.rival.build_cpu_ms, 0.5), quantile(result.ratios.match, 0.5),
        quantile(result.ratios.filter, 0.5), quantile(result.ratios.build, 0.5));
  }
  return text;
}

}  // namespace landfix::tools
