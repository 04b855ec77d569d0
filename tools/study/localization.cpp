#include "tools/study/localization.hpp"

#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "ndt/voxel_map_builder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/pcap_source.hpp"
#include "platform/pipeline.hpp"
#include "tools/cpu_clock.hpp"
#include "tools/input_files.hpp"
#include "tools/replay_run.hpp"
#include "tools/replay_setup.hpp"

namespace landfix::tools::study {
namespace {

[[nodiscard]] double median_ms(const ReplayResult& replay, platform::Stage stage) {
  return 1e-6 * static_cast<double>(replay.duration(stage).percentile_ns(50.0));
}

[[nodiscard]] LocalizationFigures localization_figures(const ReplayResult& replay, const Truth& truth) {
  if (replay.tally.came() == 0) throw std::runtime_error("no sweep came of the capture");
  LocalizationFigures figures{.sweeps = replay.tally.came(),
                              .tracking = replay.tally.count(ndt::State::tracking),
                              .lost = replay.tally.count(ndt::State::lost),
                              .points = replay.tally.points_mean(),
                              .filter_ms = median_ms(replay, platform::Stage::filter),
                              .match_ms = median_ms(replay, platform::Stage::match)};
  for (const platform::SweepResult& sweep : replay.sweeps) {
    if (sweep.missing || !ndt::is_usable(sweep.fix.state)) continue;
    truth.compare(sweep.fix.at, sweep.fix.match.iterations, figures.along);
  }
  const Along& along = figures.along;
  figures.compared = along.way_m.size();
  figures.iterations = spread_of(along.iterations);
  figures.position_rmse_m = root_mean_square(along.position_error_m);
  figures.position_max_m = largest(along.position_error_m);
  figures.heading_rmse_deg = root_mean_square(along.heading_error_deg);
  return figures;
}

}  // namespace

bool is_whole(const LocalizationFigures& figures) noexcept {
  constexpr std::size_t kFirst = 5;
  return figures.lost == 0 && figures.compared != 0 && figures.compared + kFirst >= figures.sweeps;
}

std::filesystem::path map_of(const std::filesystem::path& drive, double resolution_m) {
  std::filesystem::path path = drive / fmt::format("map-{:g}m.ndt", resolution_m);
  if (std::filesystem::exists(path)) return path;
  ndt::VoxelMapBuilder builder(resolution_m, kMapCapacity);
  visit_clouds({drive / "map.pcd"}, [&](const Eigen::Vector3d& point_m) { builder.add(point_m); });
  platform::AtomicFile file(path);
  file.write(builder.build().bytes());
  file.commit();
  return path;
}

Localization localize(const std::filesystem::path& drive, const Truth& truth, const Variation& variation) {
  const ReplaySetup setup = prepare_replay({.config = drive / "config.toml",
                                            .map = map_of(drive, variation.resolution_m),
                                            .deskew = variation.deskew,
                                            .adjust = [&](platform::Configuration& configuration) {
                                              configuration.sensor.max_range_m = variation.max_range_m;
                                              configuration.filter.leaf_m = variation.leaf_m;
                                              configuration.filter.kind =
                                                  ndt::find_filter(variation.filter).value();
                                              configuration.matcher.resolution_m = variation.resolution_m;
                                            }});
  platform::PcapSource source(drive / "capture.pcap");
  if (setup.search) setup.search->prepare();
  platform::Pipeline pipeline(setup.settings, setup.decoder, setup.map(), nullptr, setup.aids());
  ReplayResult replay;
  const double cpu_ms = cpu_ms_of([&] {
    replay = run_replay(source, pipeline, [&](const platform::SweepResult& /*sweep*/) { pipeline.search(); });
  });
  Localization result{.figures = localization_figures(replay, truth), .trajectory = replay.trajectory()};
  result.figures.cpu_ms = cpu_ms / static_cast<double>(result.figures.sweeps);
  return result;
}

std::span<const Variation> ablations() {
  static const std::array kAblations{
      Variation{.name = "range 100 m", .max_range_m = 100.0},
      Variation{.name = "range 50 m", .max_range_m = 50.0},
      Variation{.name = "range 20 m", .max_range_m = 20.0},
      Variation{.name = "leaf 0.5 m", .leaf_m = 0.5},
      Variation{.name = "leaf 1 m", .leaf_m = 1.0},
      Variation{.name = "leaf 4 m", .leaf_m = 4.0},
      Variation{.name = "filter ring", .filter = "ring"},
      Variation{.name = "filter entropy", .filter = "entropy"},
      Variation{.name = "resolution 2 m", .resolution_m = 2.0},
      Variation{.name = "no deskew", .deskew = false},
  };
  return kAblations;
}

}  // namespace landfix::tools::study
