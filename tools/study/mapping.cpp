#include "tools/study/mapping.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "drivers/sweep.hpp"
#include "tools/mapping_run.hpp"
#include "tools/quality_run.hpp"
#include "tools/simulator/drive.hpp"

namespace landfix::tools::study {
namespace {

[[nodiscard]] MappingSettings from_pose(MappingSettings settings, const ndt::Pose& first_pose) {
  settings.sensor_pose = simulator::kSensorMounting.pose();
  settings.first_pose = first_pose;
  return settings;
}

[[nodiscard]] MappingFigures mapping_figures(MappingRun& run, const std::filesystem::path& folder,
                                             const Truth& truth) {
  run.finish();
  MappingFigures figures{.sweeps = run.sweeps().size(), .points = run.map_points()};
  std::vector<double> iterations;
  std::vector<double> scores_m2;
  std::vector<double> times_ms;
  for (const MappedSweep& sweep : run.sweeps()) {
    if (sweep.added) ++figures.added;
    truth.compare(sweep.at, sweep.match.iterations, figures.along);
    if (&sweep == run.sweeps().data()) continue;  // which had nothing to be matched to
    iterations.push_back(sweep.match.iterations);
    if (std::isfinite(sweep.fitness_score_m2)) scores_m2.push_back(sweep.fitness_score_m2);
    times_ms.push_back(sweep.match_ms);
  }
  figures.iterations = spread_of(iterations);
  figures.fitness_score_m2 = spread_of(scores_m2);
  figures.match_ms = spread_of(times_ms).mean;
  figures.elevation_max_m = largest_elevation_error_m(figures.along);
  figures.position_rmse_m = root_mean_square(figures.along.position_error_m);
  const CloudQuality quality = quality_of(folder / "map.pcd");
  figures.mean_map_entropy = quality.mean_map_entropy;
  figures.mean_plane_variance_m = quality.mean_plane_variance_m;
  return figures;
}

}  // namespace

Mappings map_drive(const std::filesystem::path& drive, const CaptureInput& input, const Truth& truth) {
  const std::filesystem::path own_folder = drive / "mapping";
  const std::filesystem::path study_folder = drive / "study-mapping";
  std::filesystem::create_directories(own_folder);
  std::filesystem::create_directories(study_folder);
  DecodedCapture capture(input);
  std::optional<MappingRun> by_landfix;
  std::optional<MappingRun> by_study;
  (void)capture.read([&](const drivers::Sweep& sweep) {
    if (!sweep.complete()) return;
    if (!by_landfix) {
      const auto first_pose = platform::interpolate(truth.poses(), sweep.end_utc_ns());
      if (!first_pose) return;
      by_landfix.emplace(from_pose({}, *first_pose), own_folder);
      by_study.emplace(from_pose(study_mapping(), *first_pose), study_folder);
    }
    by_landfix->add(sweep);
    by_study->add(sweep);
  });
  if (!by_landfix || by_landfix->sweeps().size() < 2)
    throw std::runtime_error("the drive is too short: it has fewer than two whole sweeps");
  return {.by_landfix = mapping_figures(*by_landfix, own_folder, truth),
          .by_study = mapping_figures(*by_study, study_folder, truth)};
}

CloudQuality quality_of(const std::filesystem::path& cloud) {
  const QualitySettings settings{.sample = 2000};
  QualityCloud points = load_quality_cloud({cloud}, settings);
  const ndt::NeighbourTree tree(std::move(points.points_m));
  const ndt::MapQuality quality = judge_map(tree, points.chosen, settings, [](double /*share*/) {}).quality;
  if (quality.points == quality.skipped) {
    throw std::runtime_error(
        fmt::format("{}: no point has enough neighbours to measure the map by", cloud.string()));
  }
  return {.mean_map_entropy = quality.mean_map_entropy(),
          .mean_plane_variance_m = quality.mean_plane_variance_m()};
}

}  // namespace landfix::tools::study
