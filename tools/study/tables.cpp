#include "tools/study/tables.hpp"

#include <string>
#include <string_view>

#include <fmt/format.h>

#include "platform/atomic_file.hpp"

namespace landfix::tools::study {
namespace {

/// A route may be a path.
[[nodiscard]] std::string csv_text(std::string_view text) {
  std::string result(1, '"');
  for (const char letter : text) result.append(letter == '"' ? 2 : 1, letter);
  return result + '"';
}

[[nodiscard]] std::string mapping_csv(const CaseResult& result, std::string_view settings,
                                      const MappingFigures& mapping) {
  const CaseFigures& figures = *result.figures;
  return fmt::format(
      "{},{},{},{},{},{:.1f},{:.1f},{},{},{},{:.3f},{:.3f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{:.3f}"
      "\n",
      csv_text(result.one.route), result.one.sensor, settings, figures.lasers, figures.returns,
      figures.length_m, figures.duration_s, mapping.sweeps, mapping.added, mapping.points,
      mapping.iterations.mean, mapping.iterations.deviation, mapping.fitness_score_m2.mean,
      mapping.fitness_score_m2.deviation, mapping.mean_map_entropy, mapping.mean_plane_variance_m,
      mapping.elevation_max_m, mapping.position_rmse_m, mapping.match_ms);
}

[[nodiscard]] std::string localization_csv(const CaseResult& result, const LocalizationFigures& found) {
  return fmt::format("{},{},{},{},{},{:.1f},{:.3f},{:.3f},{:.5f},{:.5f},{:.5f},{:.4f},{:.4f}\n",
                     csv_text(result.one.route), result.one.sensor, found.sweeps, found.tracking, found.lost,
                     found.points, found.iterations.mean, found.iterations.deviation, found.position_rmse_m,
                     found.position_max_m, found.heading_rmse_deg, found.filter_ms, found.match_ms);
}

[[nodiscard]] std::string along_rows(const CaseResult& result, std::string_view what, const Along& along) {
  std::string rows;
  for (std::size_t i = 0; i < along.way_m.size(); ++i) {
    rows +=
        fmt::format("{},{},{},{:.3f},{:.4f},{:.4f},{:.4f},{:.4f},{}\n", csv_text(result.one.route),
                    result.one.sensor, what, along.way_m[i], along.true_elevation_m[i], along.elevation_m[i],
                    along.position_error_m[i], along.heading_error_deg[i], along.iterations[i]);
  }
  return rows;
}

}  // namespace

void write_tables(std::span<const CaseResult> results, const std::filesystem::path& folder) {
  std::string mapping =
      "route,sensor,settings,lasers,returns,length_m,duration_s,sweeps,added,points,iterations_mean,"
      "iterations_deviation,fitness_score_mean_m2,fitness_score_deviation_m2,mme,mpv_m,elevation_error_max_m,"
      "position_rmse_m,match_ms\n";
  const std::string found_columns =
      "sweeps,tracking,lost,points,iterations_mean,iterations_deviation,position_rmse_m,position_error_max_m,"
      "heading_rmse_deg,filter_ms,match_ms\n";
  std::string localization = "route,sensor," + found_columns;
  std::string variations = "variation,route,sensor," + found_columns;
  std::string along =
      "route,sensor,run,way_m,true_elevation_m,elevation_m,position_error_m,heading_error_deg,iterations\n";
  for (const CaseResult& result : results) {
    if (!result.figures) continue;
    const CaseFigures& figures = *result.figures;
    mapping +=
        mapping_csv(result, "landfix", figures.by_landfix) + mapping_csv(result, "study", figures.by_study);
    localization += localization_csv(result, figures.localization);
    for (const Variation& variation : figures.variations)
      variations += csv_text(variation.name) + ',' + localization_csv(result, variation.found);
    along += along_rows(result, "mapping", figures.by_landfix.along) +
             along_rows(result, "study-mapping", figures.by_study.along) +
             along_rows(result, "localization", figures.localization.along);
  }
  platform::write_file(folder / "mapping.csv", mapping);
  platform::write_file(folder / "localization.csv", localization);
  platform::write_file(folder / "variations.csv", variations);
  platform::write_file(folder / "along.csv", along);
}

}  // namespace landfix::tools::study
