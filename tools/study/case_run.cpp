#include "tools/study/case_run.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "platform/trajectory.hpp"
#include "tools/decoded_capture.hpp"
#include "tools/input_files.hpp"
#include "tools/sensor_setup.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/simulation.hpp"
#include "tools/study/along.hpp"
#include "tools/study/localization.hpp"
#include "tools/study/mapping.hpp"
#include "tools/study/scan_pictures.hpp"
#include "tools/study/tuning.hpp"

namespace landfix::tools::study {
namespace {

/// Each sensor is another unit, never the ideal one.
[[nodiscard]] std::uint64_t unit_of(std::string_view sensor) {
  std::uint64_t bits = 0;
  for (const char letter : sensor) bits = simulator::mix_bits(bits ^ static_cast<unsigned char>(letter));
  return 1 + bits % 1'000'000;
}

[[nodiscard]] std::unique_ptr<simulator::Drive> make_drive(const Case& one) {
  simulator::Route route = simulator::load_route(one.route);
  if (one.length_m != 0.0) route = simulator::shortened(std::move(route), one.length_m);
  const std::uint64_t seed = route.seed;
  return std::make_unique<simulator::Drive>(std::move(route), seed, one.sensor, unit_of(one.sensor));
}

[[nodiscard]] CaptureInput capture_of(const simulator::Drive& drive, const std::filesystem::path& folder) {
  const RangeLimits limits;
  const auto calibration = drive.lidar().calibration();
  return {.sensor = std::string(drive.lidar().traits().name),
          .calibration = calibration ? (folder / calibration->name).string() : std::string(),
          .pcap = (folder / "capture.pcap").string(),
          .options = {.min_range_m = limits.min_m, .max_range_m = limits.max_m}};
}

[[nodiscard]] double megabytes_in(const std::filesystem::path& folder) {
  double bytes = 0.0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  return 1e-6 * bytes;
}

/// What takes the disk, and can be made again; but for the maps, which tuned.toml names.
void drop_bulk(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> bulk;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::filesystem::path extension = entry.path().extension();
    if (extension == ".pcap" || extension == ".pcd") bulk.push_back(entry.path());
  }
  for (const std::filesystem::path& path : bulk) std::filesystem::remove(path);
}

void vary(const std::filesystem::path& folder, const Truth& truth, std::vector<Variation>& variations) {
  for (const Variation& ablation : ablations()) {
    Variation& variation = variations.emplace_back(ablation);
    variation.found = localize(folder, truth, variation).figures;
    variation.found.along = {};
  }
}

}  // namespace

CaseFigures run_case(const Case& one, const std::filesystem::path& folder) {
  const auto began = std::chrono::steady_clock::now();
  const std::unique_ptr<simulator::Drive> drive = make_drive(one);
  const simulator::SimulationSummary simulated =
      simulator::write_drive(*drive, folder, [](double /*share*/) {});
  const Truth truth(platform::read_tum(folder / "truth.tum"));
  const CaptureInput input = capture_of(*drive, folder);
  CaseFigures figures{
      .returns = simulated.returns, .length_m = simulated.length_m, .duration_s = simulated.duration_s};
  const CloudQuality survey = quality_of(folder / "map.pcd");
  figures.survey_entropy = survey.mean_map_entropy;
  figures.survey_plane_variance_m = survey.mean_plane_variance_m;

  const Localization localization = localize(folder, truth, {});
  figures.localization = localization.figures;
  const auto middle = truth.poses()[truth.poses().size() / 2].stamp_utc_ns;
  figures.has_pictures = draw_sweep(folder, input, localization.trajectory, middle);
  if (one.ablate) vary(folder, truth, figures.variations);
  if (one.tune) tune(folder, truth, figures.variations);

  Mappings mappings = map_drive(folder, input, truth);
  figures.by_landfix = std::move(mappings.by_landfix);
  figures.by_study = std::move(mappings.by_study);
  figures.lasers = find_sensor(one.sensor).beam_count;
  figures.disk_mb = megabytes_in(folder);
  if (!one.keep) drop_bulk(folder);
  figures.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return figures;
}

}  // namespace landfix::tools::study
