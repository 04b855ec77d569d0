// landfix benchmark: robustness, accuracy and time of matching, against a drive with known poses.
#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "ndt/pcd.hpp"
#include "ndt/pcd_header.hpp"
#include "ndt/voxel_map_builder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/trajectory.hpp"
#include "tools/benchmark_run.hpp"
#include "tools/command.hpp"
#include "tools/input_files.hpp"
#include "tools/landfix_commands.hpp"

namespace landfix::tools {
namespace {

struct Arguments {
  std::string map;
  std::string scans;
  std::string truth;
  double resolution_m = 1.0;
  std::vector<double> perturb{0.5, 2.0};  // m, deg
  std::vector<double> perturb_exact;      // m, deg
  BenchmarkSettings settings;
  bool json = false;
};

struct LoadedMap {
  ndt::MapImage image;
  std::optional<double> build_ms;  ///< nothing where the file is a finished map
};

[[nodiscard]] LoadedMap load(const Arguments& arguments) {
  if (!arguments.map.ends_with(".pcd")) return {load_map_file(arguments.map), std::nullopt};
  const auto file = platform::read_file(arguments.map);
  // Memory follows the points, but not a header that claims more of them than a map has voxels.
  const std::size_t points = ndt::read_pcd_header(file, arguments.map).points;
  const auto began = std::chrono::steady_clock::now();
  ndt::VoxelMapBuilder builder(arguments.resolution_m, std::clamp(points, std::size_t{1}, kMapCapacity));
  ndt::visit_pcd_positions(file, arguments.map,
                           [&builder](const Eigen::Vector3d& point_m) { builder.add(point_m); });
  LoadedMap map{builder.build(), 0.0};
  map.build_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
  return map;
}

/// Over all starts, failed ones included.
struct Summary {
  double ok_percent = 0.0;
  double iterations_mean = 0.0;
  std::vector<double> error_cm;
  std::vector<double> error_deg;
  std::vector<double> match_cpu_ms;
};

[[nodiscard]] Summary summarise(const std::vector<BenchmarkSample>& samples) {
  Summary summary;
  const auto count = static_cast<double>(samples.size());
  summary.ok_percent = 100.0 *
                       static_cast<double>(std::count_if(samples.begin(), samples.end(),
                                                         [](const auto& sample) { return sample.ok(); })) /
                       count;
  for (const BenchmarkSample& sample : samples) {
    summary.iterations_mean += sample.iterations / count;
    summary.error_cm.push_back(100.0 * sample.error_m);
    summary.error_deg.push_back(sample.error_rad / kRadians_per_deg);
    summary.match_cpu_ms.push_back(sample.match_cpu_ms);
  }
  return summary;
}

void print_json(const BenchmarkResult& result, const Summary& summary, const ndt::VoxelMap& map,
                const LoadedMap& loaded) {
  const auto median_and = [](const char* name, double p, const std::vector<double>& values) {
    return nlohmann::json{{"median", quantile(values, 0.5)}, {name, quantile(values, p)}};
  };
  const nlohmann::json object{
      {"scans", result.scans},
      {"starts", result.samples.size()},
      {"points_mean", result.points_mean},
      {"ok_percent", summary.ok_percent},
      {"error_cm", median_and("p95", 0.95, summary.error_cm)},
      {"error_deg", median_and("p95", 0.95, summary.error_deg)},
      {"iterations_mean", summary.iterations_mean},
      {"filter_cpu_ms", median_and("p99", 0.99, result.filter_cpu_ms)},
      {"match_cpu_ms", median_and("p99", 0.99, summary.match_cpu_ms)},
      {"map",
       {{"voxels", map.voxels().size()},
        {"bytes", loaded.image.bytes().size()},
        {"build_ms", loaded.build_ms ? nlohmann::json(*loaded.build_ms) : nlohmann::json()}}}};
  fmt::print("{}\n", object.dump(2));
}

void print_text(const BenchmarkResult& result, const Summary& summary, const ndt::VoxelMap& map,
                const LoadedMap& loaded) {
  fmt::print(
      "scans        {}, {} starts, {:.0f} points on average\n"
      "ok           {:.2f} % (within 10 cm and 0.5 deg of the truth)\n"
      "error        median {:.2f} cm, {:.3f} deg; p95 {:.2f} cm, {:.3f} deg\n"
      "iterations   {:.2f} on average\n"
      "filter       median {:.3f} ms, p99 {:.3f} ms of CPU\n"
      "match        median {:.3f} ms, p99 {:.3f} ms of CPU\n"
      "map          {} voxels, {} bytes{}\n",
      result.scans, result.samples.size(), result.points_mean, summary.ok_percent,
      quantile(summary.error_cm, 0.5), quantile(summary.error_deg, 0.5), quantile(summary.error_cm, 0.95),
      quantile(summary.error_deg, 0.95), summary.iterations_mean, quantile(result.filter_cpu_ms, 0.5),
      quantile(result.filter_cpu_ms, 0.99), quantile(summary.match_cpu_ms, 0.5),
      quantile(summary.match_cpu_ms, 0.99), map.voxels().size(), loaded.image.bytes().size(),
      loaded.build_ms ? fmt::format(", built in {:.1f} ms", *loaded.build_ms) : "");
}

void benchmark(const Arguments& arguments) {
  BenchmarkSettings settings = arguments.settings;
  const std::vector<double>& perturb =
      arguments.perturb_exact.empty() ? arguments.perturb : arguments.perturb_exact;
  settings.perturb_exactly = !arguments.perturb_exact.empty();
  settings.perturb_m = perturb[0];
  settings.perturb_rad = perturb[1] * kRadians_per_deg;

  const auto scans = list_clouds(arguments.scans);
  const auto truth = platform::read_tum(arguments.truth);
  if (truth.size() != scans.size()) {
    throw UsageError(fmt::format(
        "{} has {} scans, {} has {} poses: they go together in order, so their numbers must agree",
        arguments.scans, scans.size(), arguments.truth, truth.size()));
  }
  const LoadedMap loaded = load(arguments);
  const ndt::VoxelMap map(loaded.image.bytes());
  const BenchmarkResult result = run_benchmark(map, scans, truth, settings);
  (arguments.json ? print_json : print_text)(result, summarise(result.samples), map, loaded);
}

}  // namespace

void add_benchmark_command(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  BenchmarkSettings& settings = arguments->settings;
  CLI::App& command =
      *app.add_subcommand("benchmark", "robustness, accuracy and time of matching against known poses");
  command.add_option("--map", arguments->map, "map; of a .pcd one is built first, and the build timed")
      ->required()
      ->type_name("MAP.ndt|MAP.pcd");
  command.add_option("--resolution", arguments->resolution_m, "edge of a voxel of a map that is built [m]")
      ->check(CLI::Range(0.05, 100.0).description(""))
      ->type_name("M")
      ->capture_default_str();
  command.add_option("--scans", arguments->scans, "folder of scans in the vehicle frame, taken by name")
      ->required()
      ->type_name("DIR");
  command.add_option("--truth", arguments->truth, "a pose for each scan, in the same order")
      ->required()
      ->type_name("TRUTH.tum");
  command.add_option("--starts", settings.starts, "starts around the truth of each scan")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000}).description(""))
      ->type_name("N")
      ->capture_default_str();
  const auto add_perturbation = [&command](const char* name, std::vector<double>& values, const char* what) {
    return command.add_option(name, values, what)
        ->delimiter(',')
        ->expected(2)
        ->check(CLI::NonNegativeNumber.description(""))
        ->type_name("M,DEG");
  };
  auto* const up_to = add_perturbation("--perturb", arguments->perturb, "starts up to so far from the truth")
                          ->default_str("0.5,2");
  auto* const exact =
      add_perturbation("--perturb-exact", arguments->perturb_exact, "starts exactly so far from the truth")
          ->excludes(up_to);
  command
      .add_flag("--sequence", settings.in_sequence,
                "track the scans in order, from the first one's true pose, instead of starting around each")
      ->excludes(up_to)
      ->excludes(exact);
  add_filter_options(command, settings.filter);
  add_range_options(command, settings.limits);
  command.add_option("--seed", settings.seed, "of the starts")->type_name("N")->capture_default_str();
  add_json_option(command, arguments->json);
  command.callback([arguments] { benchmark(*arguments); });
}

}  // namespace landfix::tools
