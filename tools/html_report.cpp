#include "tools/html_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "platform/evaluation.hpp"
#include "platform/hgrm.hpp"
#include "tools/html_page.hpp"
#include "tools/latency_chart.hpp"
#include "tools/latency_table.hpp"
#include "tools/strip_chart.hpp"
#include "tools/trajectory_svg.hpp"

namespace landfix::tools {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

[[nodiscard]] std::string zero_is_good(std::uint64_t count, std::string_view what) {
  return tile(fmt::format("{}", count), what, count == 0 ? Mood::good : Mood::bad);
}

[[nodiscard]] std::vector<platform::LatencyDistribution> distributions_of(const ReplayResult& result) {
  std::vector<platform::LatencyDistribution> stages;
  for (std::size_t i = 0; i < platform::kStageCount; ++i) {
    const auto stage = static_cast<platform::Stage>(i);
    if (result.duration(stage).count() == 0) continue;  // not of this kind of replay
    stages.push_back(platform::distribution_of(result.duration(stage), to_string(stage)));
  }
  return stages;
}

[[nodiscard]] std::string tiles_of(const HtmlReport& report,
                                   const std::vector<platform::LatencyDistribution>& stages) {
  const ReplayResult& result = report.replay.result;
  const double sweeps = static_cast<double>(std::max<std::size_t>(result.sweeps.size(), 1));
  const double tracked_percent =
      100.0 * static_cast<double>(result.tally.count(ndt::State::tracking)) / sweeps;
  std::string tiles = tile(fmt::format("{}", result.sweeps.size() - result.tally.missing()), "sweeps");
  tiles += tile(fmt::format("{:.1f} %", tracked_percent), "tracking");
  tiles += zero_is_good(result.tally.count(ndt::State::lost), "lost");
  if (report.replay.evaluation) {
    const platform::Evaluation& errors = *report.replay.evaluation;
    tiles += tile(fmt::format("{:.2f} cm", 100.0 * errors.ate_m.rmse), "position error, RMSE");
    tiles += tile(fmt::format("{:.3f}°", errors.heading_deg.rmse), "heading error, RMSE");
  }
  for (const platform::LatencyDistribution& stage : stages) {
    if (stage.stage != "total" && stage.stage != "last_packet") continue;
    const bool is_total = stage.stage == "total";
    tiles += tile(fmt::format("{:.2f} ms", stage.percentile_ms(50.0)),
                  is_total ? "last packet to bus, p50" : "last packet to pose, p50");
    tiles += tile(fmt::format("{:.2f} ms", stage.percentile_ms(99.9)),
                  is_total ? "last packet to bus, p99.9" : "last packet to pose, p99.9");
  }
  tiles += zero_is_good(result.stream.lost_packets, "packets lost");
  if (result.heap_calls) tiles += zero_is_good(*result.heap_calls, "heap calls, packet to pose");
  return "<div class=\"tiles\">\n" + tiles + "</div>\n";
}

[[nodiscard]] StripChart strips_of(const HtmlReport& report) {
  StripChart chart;
  std::vector<StripChart::Strip> strips{{"position error [cm]", {}},
                                        {"score: likelihood as a share of the best", {}},
                                        {"position sigma, horizontal [cm]", {}},
                                        {"iterations", {}},
                                        {"points after the filter", {}},
                                        {"filter's rest and match, after the last packet [ms]", {}}};
  const std::vector<platform::SweepResult>& sweeps = report.replay.result.sweeps;
  double last_s = 0.0;
  for (const platform::SweepResult& sweep : sweeps) {
    const double since_first_s =
        1e-9 * static_cast<double>(sweep.fix.at.stamp_utc_ns - sweeps.front().fix.at.stamp_utc_ns);
    last_s = std::max(last_s, since_first_s);  // a clock may be set back
    chart.times_s.push_back(last_s);
    chart.states.push_back(sweep.fix.state);
    const bool usable = ndt::is_usable(sweep.fix.state);
    const bool matched = !sweep.missing && !sweep.skipped;
    const ndt::MatchResult& match = sweep.fix.match;
    const auto truth = platform::interpolate(report.truth, sweep.fix.at.stamp_utc_ns);
    const Eigen::Vector3d position_m = sweep.fix.at.pose.translation();
    const double error_m = truth && usable ? (truth->translation() - position_m).norm() : kNone;
    const double variance_m2 = std::max(sweep.fix.covariance(0, 0), sweep.fix.covariance(1, 1));
    const bool known = usable && variance_m2 < 1e4;
    const std::array<double, 6> values{
        100.0 * error_m,
        matched ? match.nearest_voxel_likelihood / match.best_likelihood : kNone,
        known ? 100.0 * std::sqrt(variance_m2) : kNone,
        matched ? static_cast<double>(match.iterations) : kNone,
        matched ? static_cast<double>(sweep.points_filtered) : kNone,
        matched ? 1e-6 * static_cast<double>(sweep.times.matched_ns - sweep.times.last_packet_ns) : kNone};
    for (std::size_t i = 0; i < values.size(); ++i) strips[i].values.push_back(values[i]);
  }
  for (StripChart::Strip& strip : strips) {
    const bool any = std::ranges::any_of(strip.values, [](double value) { return std::isfinite(value); });
    if (any) chart.strips.push_back(std::move(strip));
  }
  return chart;
}

[[nodiscard]] std::string key_of_states(const ReplayResult& result) {
  std::string key = "<div class=\"key\">";
  for (int i = 5; i >= 0; --i) {
    const auto state = static_cast<ndt::State>(i);
    if (result.tally.count(state) == 0) continue;
    key += fmt::format("<span><i style=\"background:{}\"></i>{} {}</span>", colour_of(state),
                       ndt::to_string(state), result.tally.count(state));
  }
  return key + "</div>\n";
}

[[nodiscard]] std::string latency_section(const std::vector<platform::LatencyDistribution>& stages) {
  if (stages.empty()) return {};
  std::string rows;
  for (const platform::LatencyDistribution& stage : stages) {
    rows += fmt::format("<tr><td>{}</td>", stage.stage);
    for (const double value_ms : latency_of(stage).values_ms)
      rows += fmt::format("<td>{:.3f}</td>", value_ms);
    rows += fmt::format("<td>{:.3f}</td><td>{}</td></tr>\n", stage.mean_ms, stage.count());
  }
  return fmt::format(
      "<section><h2>Latencies by stage</h2>\n<div class=\"scroll\">{}</div>\n<div class=\"scroll\"><table>\n"
      "<tr><th>[ms]</th><th>p50</th><th>p90</th><th>p99</th><th>p99.9</th><th>max</th><th>mean</th>"
      "<th>count</th></tr>\n{}</table></div></section>\n",
      latency_chart_svg(stages), rows);
}

[[nodiscard]] std::string error_section(const platform::Evaluation& errors) {
  struct ErrorRow {
    std::string_view name;
    const platform::ErrorStatistics& errors;
    double factor;
  };
  const std::array<ErrorRow, 7> rows{{{"position [cm]", errors.ate_m, 100.0},
                                      {"elevation [cm]", errors.elevation_m, 100.0},
                                      {"heading [deg]", errors.heading_deg, 1.0},
                                      {"roll [deg]", errors.roll_deg, 1.0},
                                      {"pitch [deg]", errors.pitch_deg, 1.0},
                                      {"relative, 1 s [cm]", errors.rpe_m, 100.0},
                                      {"relative, 1 s [deg]", errors.rpe_deg, 1.0}}};
  std::string text;
  for (const ErrorRow& row : rows) {
    text += fmt::format("<tr><td>{}</td>", row.name);
    for (const double value : {row.errors.rmse, row.errors.mean, row.errors.median, row.errors.max}) {
      text +=
          std::isnan(value) ? std::string("<td>-</td>") : fmt::format("<td>{:.3f}</td>", value * row.factor);
    }
    text += "</tr>\n";
  }
  return fmt::format(
      "<section><h2>Error against the truth, {} poses</h2>\n<div class=\"scroll\"><table>\n<tr><th></th>"
      "<th>RMSE</th><th>mean</th><th>median</th><th>max</th></tr>\n{}</table></div></section>\n",
      errors.pairs, text);
}

/// All figures of the JSON that are counts, nested ones as "group: name".
[[nodiscard]] std::string counter_rows(const nlohmann::ordered_json& object, const std::string& prefix) {
  std::string rows;
  for (const auto& [key, value] : object.items()) {
    std::string name = key;
    std::ranges::replace(name, '_', ' ');
    if (value.is_object() && key != "stage_ms" && key != "evaluation" && key != "nees")
      rows += counter_rows(value, prefix + name + ": ");
    else if (value.is_number_integer())
      rows += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", prefix + name, value.dump());
  }
  return rows;
}

}  // namespace

std::string to_html(const HtmlReport& report) {
  const ReplayResult& result = report.replay.result;
  const nlohmann::ordered_json json = to_json(report.replay);
  const std::vector<platform::LatencyDistribution> stages = distributions_of(result);
  std::string page =
      html_head("Replay of " + report.capture) +
      fmt::format("<p class=\"soft\">{}, against {}</p>\n", html_of(report.sensor), html_of(report.map));
  page += tiles_of(report, stages);
  page += "<section><h2>Trajectory over the map</h2>\n<div class=\"scroll map\">" +
          trajectory_svg(report.map_points_m, result.trajectory(), report.truth) + "</div></section>\n";
  page += "<section><h2>Along the way</h2>\n" + key_of_states(result) + "<div class=\"scroll\">" +
          strip_chart_svg(strips_of(report)) + "</div></section>\n";
  if (report.replay.evaluation) page += error_section(*report.replay.evaluation);
  page += latency_section(stages);
  page += "<section><h2>Counters</h2>\n<div class=\"scroll\"><table>\n" + counter_rows(json, "") +
          "</table></div></section>\n";
  page += fmt::format(
      "<section><h2>How it was made</h2>\n<p class=\"soft\">landfix {}</p>\n<pre>{}</pre>\n"
      "<details><summary>All figures, as --json prints them</summary>\n<pre>{}</pre></details></section>\n",
      html_of(report.version), html_of(report.command), html_of(json.dump(2)));
  return page + std::string(kHtmlTail);
}

}  // namespace landfix::tools
