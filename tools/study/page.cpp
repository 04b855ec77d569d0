#include "tools/study/page.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "tools/html_page.hpp"
#include "tools/line_chart.hpp"
#include "tools/study/localization.hpp"

namespace landfix::tools::study {
namespace {

/// A. Carballo et al., "Characterization of Multiple 3D LiDARs for Localization and Mapping using Normal
/// Distributions Transform", 2020: of its surveyed map.
constexpr double kPublishedEntropy = 0.294893;
constexpr double kPublishedPlaneVariance_m = 0.669889;

using Results = std::vector<const CaseResult*>;

[[nodiscard]] Results done(std::span<const CaseResult> results) {
  Results found;
  for (const CaseResult& result : results)
    if (result.figures) found.push_back(&result);
  return found;
}

[[nodiscard]] std::vector<std::string> routes_of(const Results& results) {
  std::vector<std::string> routes;
  for (const CaseResult* result : results)
    if (std::ranges::find(routes, result->one.route) == routes.end()) routes.push_back(result->one.route);
  return routes;
}

[[nodiscard]] Results on_route(const Results& results, const std::string& route) {
  Results found;
  for (const CaseResult* result : results)
    if (result->one.route == route) found.push_back(result);
  return found;
}

/// What is asked of the mapping: a quarter of the study's largest elevation error where that is more than
/// 0.2 m, else 5 cm.
[[nodiscard]] bool drifts_little(const CaseFigures& figures) {
  constexpr double kMuch_m = 0.2;
  constexpr double kLittle_m = 0.05;
  if (figures.by_landfix.along.way_m.size() < 2) return false;  // nothing to compare
  const double study_m = figures.by_study.elevation_max_m;
  return figures.by_landfix.elevation_max_m <= (study_m > kMuch_m ? 0.25 * study_m : kLittle_m);
}

// And of the localization.
constexpr double kMostPosition_m = 0.05;
constexpr double kMostHeading_deg = 0.1;

[[nodiscard]] bool is_localized(const LocalizationFigures& found) {
  return is_whole(found) && found.position_rmse_m <= kMostPosition_m &&
         found.heading_rmse_deg <= kMostHeading_deg;
}

[[nodiscard]] std::string cell(const std::string& text, bool is_good) {
  return fmt::format("<td class=\"{}\">{}</td>", is_good ? "good" : "bad", text);
}

[[nodiscard]] std::string spread(const Spread& values, int decimals) {
  return fmt::format("<td>{:.{}f} ± {:.{}f}</td>", values.mean, decimals, values.deviation, decimals);
}

[[nodiscard]] std::string section(std::string_view title, const std::string& body) {
  return fmt::format("<section><h2>{}</h2>\n{}</section>\n", title, body);
}

[[nodiscard]] std::string table(std::string_view head, const std::string& rows) {
  return fmt::format("<div class=\"scroll\"><table>\n<tr>{}</tr>\n{}</table></div>\n", head, rows);
}

[[nodiscard]] std::string tiles_of(const StudyPage& page, const Results& results) {
  const auto count = [&](const auto& is_so) { return std::ranges::count_if(results, is_so); };
  const auto all = static_cast<std::ptrdiff_t>(page.results.size());
  const auto mapped = count([](const CaseResult* one) { return drifts_little(*one->figures); });
  const auto localized =
      count([](const CaseResult* one) { return is_localized(one->figures->localization); });
  double seconds = 0.0;
  double disk_mb = 0.0;
  for (const CaseResult* result : results) {
    seconds += result->figures->seconds;
    disk_mb = std::max(disk_mb, result->figures->disk_mb);
  }
  const auto of_all = [&](std::ptrdiff_t good) { return fmt::format("{} of {}", good, all); };
  const auto mood = [&](std::ptrdiff_t good) { return good == all ? Mood::good : Mood::bad; };
  const auto finished = static_cast<std::ptrdiff_t>(results.size());
  return "<div class=\"tiles\">\n" + tile(of_all(finished), "runs finished", mood(finished)) +
         tile(of_all(localized), "localized: none lost, 5 cm, 0.1°", mood(localized)) +
         tile(of_all(mapped), "mapped: a quarter of the study's drift, or 5 cm", mood(mapped)) +
         tile(fmt::format("{:.0f} min", page.seconds / 60.0), "this run took") +
         tile(fmt::format("{:.0f} min", seconds / 60.0), "all runs together") +
         tile(fmt::format("{:.1f} GB", 1e-3 * disk_mb), "disk that the largest run needed") + "</div>\n";
}

[[nodiscard]] std::string failures_of(std::span<const CaseResult> results) {
  std::string rows;
  for (const CaseResult& result : results)
    if (!result.figures)
      rows +=
          fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", html_of(result.one.name()), html_of(result.error));
  return rows.empty() ? rows : section("Not finished", table("<th>run</th><th>why</th>", rows));
}

[[nodiscard]] std::string mapping_row(const CaseResult& result, std::string_view settings,
                                      const MappingFigures& mapping) {
  return fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td>", html_of(result.one.sensor), settings,
                     mapping.sweeps, mapping.added) +
         fmt::format("<td>{:.1f}</td>", 1e-6 * static_cast<double>(mapping.points)) +
         spread(mapping.iterations, 1) + spread(mapping.fitness_score_m2, 3) +
         fmt::format("<td>{:.3f}</td><td>{:.3f}</td><td>{:.2f}</td>", mapping.mean_map_entropy,
                     mapping.mean_plane_variance_m, mapping.position_rmse_m);
}

[[nodiscard]] std::string mapping_table(const Results& results) {
  std::string rows;
  for (const CaseResult* result : results) {
    const CaseFigures& figures = *result->figures;
    rows += mapping_row(*result, "landfix", figures.by_landfix) +
            cell(fmt::format("{:.3f}", figures.by_landfix.elevation_max_m), drifts_little(figures)) +
            "</tr>\n";
    rows += mapping_row(*result, "study", figures.by_study) +
            fmt::format("<td>{:.3f}</td></tr>\n", figures.by_study.elevation_max_m);
  }
  return table(
      "<th>sensor</th><th>settings</th><th>sweeps</th><th>added</th><th>points [M]</th><th>iterations</th>"
      "<th>fitness score [m²]</th><th>MME</th><th>MPV [m]</th><th>position RMSE [m]</th>"
      "<th>elevation, largest error [m]</th>",
      rows);
}

[[nodiscard]] std::string localization_table(const Results& results) {
  std::string rows;
  for (const CaseResult* result : results) {
    const LocalizationFigures& found = result->figures->localization;
    rows +=
        fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td>", html_of(result->one.sensor), found.sweeps,
                    found.tracking) +
        cell(fmt::format("{}", found.lost), is_whole(found)) + fmt::format("<td>{:.0f}</td>", found.points) +
        spread(found.iterations, 1) +
        cell(fmt::format("{:.2f}", 100.0 * found.position_rmse_m), found.position_rmse_m <= kMostPosition_m) +
        fmt::format("<td>{:.1f}</td>", 100.0 * found.position_max_m) +
        cell(fmt::format("{:.3f}", found.heading_rmse_deg), found.heading_rmse_deg <= kMostHeading_deg) +
        fmt::format("<td>{:.2f}</td><td>{:.2f}</td><td>{:.2f}</td></tr>\n", found.filter_ms, found.match_ms,
                    found.cpu_ms);
  }
  return table(
      "<th>sensor</th><th>sweeps</th><th>tracking</th><th>lost</th><th>points</th><th>iterations</th>"
      "<th>position RMSE [cm]</th><th>largest [cm]</th><th>heading RMSE [°]</th><th>filter [ms]</th>"
      "<th>match [ms]</th><th>CPU, decoding and all [ms]</th>",
      rows);
}

[[nodiscard]] std::string sensors_table(const Results& results) {
  std::string rows;
  for (const CaseResult* result : results) {
    const CaseFigures& figures = *result->figures;
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.1f}</td><td>{:.0f}</td><td>{:.0f}</td><td>{:.3f}</td>"
        "<td>{:.3f}</td></tr>\n",
        html_of(result->one.route), html_of(result->one.sensor), figures.lasers,
        1e-6 * static_cast<double>(figures.returns), figures.length_m, figures.duration_s,
        figures.survey_entropy, figures.survey_plane_variance_m);
  }
  return table(
             "<th>route</th><th>sensor</th><th>lasers</th><th>returns [M]</th><th>way [m]</th><th>time "
             "[s]</th>"
             "<th>surveyed map: MME</th><th>MPV [m]</th>",
             rows) +
         fmt::format("<p class=\"soft\">The surveyed map of the reference study: MME {}, MPV {} m.</p>\n",
                     kPublishedEntropy, kPublishedPlaneVariance_m);
}

/// A line a run: a value along its way.
template <class Value>
[[nodiscard]] LineChart chart_of(const Results& results, const std::string& title, std::string_view unit,
                                 const Along& (*along_of)(const CaseFigures&), const Value& value) {
  LineChart chart{.title = title, .x_unit = "m travelled", .y_unit = unit, .lines = {}};
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Along& along = along_of(*results[i]->figures);
    LineChart::Line& line = chart.lines.emplace_back();
    line.name = results[i]->one.sensor;
    line.colour = line_colour(i);
    line.x = along.way_m;
    for (std::size_t j = 0; j < along.way_m.size(); ++j) line.y.push_back(value(along, j));
  }
  return chart;
}

const Along& landfix_along(const CaseFigures& figures) { return figures.by_landfix.along; }
const Along& study_along(const CaseFigures& figures) { return figures.by_study.along; }
const Along& localization_along(const CaseFigures& figures) { return figures.localization.along; }

[[nodiscard]] std::string drawn(const LineChart& chart) {
  return "<div class=\"scroll\">" + line_chart_svg(chart) + "</div>\n";
}

void add_truth(const Results& results, LineChart& chart) {
  const Along& along = results.front()->figures->localization.along;
  chart.lines.push_back(
      {.name = "truth", .colour = "currentColor", .x = along.way_m, .y = along.true_elevation_m});
}

[[nodiscard]] std::string mapping_charts(const Results& results) {
  const auto elevation = [](const Along& along, std::size_t i) { return along.elevation_m[i]; };
  const auto error = [](const Along& along, std::size_t i) {
    return along.elevation_m[i] - along.true_elevation_m[i];
  };
  LineChart by_landfix = chart_of(results, "elevation, mapped by landfix", "m", landfix_along, elevation);
  LineChart by_study = chart_of(results, "elevation, by the study's settings", "m", study_along, elevation);
  add_truth(results, by_landfix);
  add_truth(results, by_study);
  return drawn(by_landfix) + drawn(by_study) +
         drawn(chart_of(results, "error of the elevation, landfix", "m", landfix_along, error)) +
         drawn(chart_of(results, "error of the elevation, the study's settings", "m", study_along, error));
}

[[nodiscard]] std::string localization_charts(const Results& results) {
  return drawn(chart_of(results, "iterations a sweep", "", localization_along,
                        [](const Along& along, std::size_t i) { return along.iterations[i]; })) +
         drawn(
             chart_of(results, "position error", "cm", localization_along,
                      [](const Along& along, std::size_t i) { return 100.0 * along.position_error_m[i]; })) +
         drawn(chart_of(results, "heading error", "°", localization_along,
                        [](const Along& along, std::size_t i) { return along.heading_error_deg[i]; }));
}

[[nodiscard]] std::string variations_table(const Results& results) {
  std::string rows;
  const auto add = [&rows](const CaseResult& result, std::string_view name,
                           const LocalizationFigures& found) {
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.0f}</td><td>{:.1f}</td><td>{:.2f}</td>"
        "<td>{:.3f}</td><td>{:.2f}</td></tr>\n",
        html_of(result.one.route), html_of(result.one.sensor), html_of(name), found.lost, found.points,
        found.iterations.mean, 100.0 * found.position_rmse_m, found.heading_rmse_deg, found.cpu_ms);
  };
  for (const CaseResult* result : results) {
    if (result->figures->variations.empty()) continue;
    add(*result, "as above", result->figures->localization);
    for (const Variation& variation : result->figures->variations)
      add(*result, variation.name, variation.found);
  }
  if (rows.empty()) return {};
  return section(
      "One thing set otherwise",
      table("<th>route</th><th>sensor</th><th>what</th><th>lost</th><th>points</th><th>iterations</th>"
            "<th>position RMSE [cm]</th><th>heading RMSE [°]</th><th>CPU [ms]</th>",
            rows));
}

[[nodiscard]] std::string pictures_of(const Results& results) {
  std::string figures;
  for (const CaseResult* result : results) {
    if (!result->figures->has_pictures) continue;
    const std::string name = html_of(result->one.name());
    figures += fmt::format(
        "<figure><figcaption>{0}</figcaption><img loading=\"lazy\" alt=\"{0}: a sweep over the map\" "
        "src=\"{0}/scan.svg\"/><img loading=\"lazy\" alt=\"{0}: the sweep, filtered\" "
        "src=\"{0}/filtered.svg\"/></figure>\n",
        name);
  }
  return section("A sweep of each, half way: over the map, and thinned at 200, 100, 50 and 20 m",
                 "<div class=\"pictures\">\n" + figures + "</div>\n");
}

}  // namespace

std::string to_html(const StudyPage& page) {
  const Results results = done(page.results);
  std::string text =
      html_head("The study: sensors and routes") +
      "<p class=\"soft\">Simulated drives, each with a unit of its sensor that errs as real ones "
      "do. Mapped without any other sensor, by landfix's settings and by the reference study's; "
      "localized in the surveyed map.</p>\n" +
      tiles_of(page, results) + failures_of(page.results);
  if (!results.empty()) text += section("Sensors, routes, surveyed maps", sensors_table(results));
  for (const std::string& route : routes_of(results)) {
    const Results here = on_route(results, route);
    text += section("Route " + html_of(route) + ": mapping", mapping_table(here) + mapping_charts(here));
    text += section("Route " + html_of(route) + ": localization",
                    localization_table(here) + localization_charts(here));
  }
  text += variations_table(results) + pictures_of(results);
  text += section("How it was made", fmt::format("<p class=\"soft\">landfix {}</p>\n<pre>{}</pre>\n",
                                                 html_of(page.version), html_of(page.command)));
  return text + std::string(kHtmlTail);
}

}  // namespace landfix::tools::study
