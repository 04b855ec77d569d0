// landfix benchmark: robustness, accuracy and time of matching, against a drive with known poses.
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "ndt/pcd.hpp"
#include "platform/atomic_file.hpp"
#include "platform/trajectory.hpp"
#include "tools/benchmark_report.hpp"
#include "tools/benchmark_run.hpp"
#include "tools/command.hpp"
#include "tools/cpu_clock.hpp"
#include "tools/input_files.hpp"
#include "tools/landfix_commands.hpp"

namespace landfix::tools {
namespace {

struct BenchmarkArguments {
  std::string map;
  std::string scans;
  std::string truth;
  double resolution_m = 1.0;
  std::vector<double> perturb{0.5, 2.0};  // m, deg
  std::vector<double> perturb_exact;      // m, deg
  std::string rival;
  BenchmarkSettings settings;
  bool json = false;
};

/// The points of a cloud, in the order of the file.
[[nodiscard]] std::vector<Eigen::Vector3d> read_cloud(const std::string& path) {
  std::vector<Eigen::Vector3d> points_m;
  ndt::visit_pcd_positions(platform::read_file(path), path,
                           [&points_m](const Eigen::Vector3d& point_m) { points_m.push_back(point_m); });
  return points_m;
}

[[nodiscard]] ndt::MapImage load(const BenchmarkArguments& arguments, PclRival* rival,
                                 BenchmarkReport& report) {
  if (!arguments.map.ends_with(".pcd")) return load_map_file(arguments.map);
  std::vector<Eigen::Vector3d> points_m;
  report.map_read_ms = cpu_ms_of([&] { points_m = read_cloud(arguments.map); });
  return build_timed(points_m, arguments.resolution_m, rival, report.result);
}

void benchmark(const BenchmarkArguments& arguments) {
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
  if (!arguments.rival.empty() && !arguments.map.ends_with(".pcd")) {
    throw UsageError(
        fmt::format("{}: the rival builds its map of the points; give --map the .pcd that this one is of",
                    arguments.map));
  }
  std::unique_ptr<PclRival> rival;
  if (!arguments.rival.empty()) {
    rival = std::make_unique<PclRival>(arguments.resolution_m, settings.filter.leaf_m);
  }

  BenchmarkReport report;
  if (rival) report.rival_name = PclRival::name();
  const ndt::MapImage image = load(arguments, rival.get(), report);
  const ndt::VoxelMap map(image.bytes());
  report.map_voxels = map.voxels().size();
  report.map_bytes = image.bytes().size();
  run_benchmark(map, scans, truth, settings, rival.get(), report.result);
  fmt::print("{}", arguments.json ? to_json(report).dump(2) + "\n" : to_text(report));
}

}  // namespace

void add_benchmark_command(CLI::App& app) {
  const auto arguments = std::make_shared<BenchmarkArguments>();
  BenchmarkSettings& settings = arguments->settings;
  CLI::App& command =
      *app.add_subcommand("benchmark", "robustness, accuracy and time of matching against known poses");
  command.add_option("--map", arguments->map, "map; of a .pcd one is built first, and the build timed")
      ->required()
      ->type_name("MAP.ndt|MAP.pcd");
  command.add_option("--resolution", arguments->resolution_m, "edge of a voxel of a map that is built [m]")
      ->check(in_range(0.05, 100.0))
      ->type_name("M")
      ->capture_default_str();
  command.add_option("--scans", arguments->scans, "folder of scans in the vehicle frame, taken by name")
      ->required()
      ->type_name("DIR");
  command.add_option("--truth", arguments->truth, "a pose for each scan, in the same order")
      ->required()
      ->type_name("TRUTH.tum");
  command.add_option("--starts", settings.starts, "starts around the truth of each scan")
      ->check(in_range(std::size_t{1}, std::size_t{1'000'000}))
      ->type_name("N")
      ->capture_default_str();
  const auto add_perturbation = [&command](const char* name, std::vector<double>& values, const char* what) {
    return command.add_option(name, values, what)
        ->delimiter(',')
        ->expected(2)
        ->check(in_range(0.0, 1e9))
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
  command
      .add_option("--rival", arguments->rival,
                  "what to hold landfix against, on the same starts: pcl, its NDT at the same resolution and "
                  "leaf")
      ->check(CLI::IsMember({"pcl"}).description(""))
      ->type_name("NAME");
  command
      .add_option("--rival-starts", settings.rival_starts, "of each scan's starts, those for the rival too")
      ->check(in_range(std::size_t{1}, std::size_t{1'000'000}))
      ->type_name("N")
      ->capture_default_str();
  add_json_option(command, arguments->json);
  command.callback([arguments] { benchmark(*arguments); });
}

}  // namespace landfix::tools
