// landfix mapping: a map from a drive whose poses are not known.
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "platform/trajectory.hpp"
#include "tools/command.hpp"
#include "tools/decoded_capture.hpp"
#include "tools/input_files.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/mapping_run.hpp"

namespace landfix::tools {
namespace {

struct MappingArguments {
  CaptureInput capture;
  std::string scans;
  std::string stamps;
  std::string output;
  std::optional<ndt::Pose> sensor_pose;
  std::optional<ndt::Pose> first_pose;
  MappingSettings settings;
  bool study_settings = false;
  bool json = false;
};

[[nodiscard]] MappingSettings settings_of(const MappingArguments& arguments) {
  MappingSettings settings = arguments.study_settings ? study_mapping() : arguments.settings;
  settings.sensor_pose = arguments.sensor_pose.value_or(ndt::Pose::Identity());
  settings.first_pose = arguments.first_pose.value_or(ndt::Pose::Identity());
  return settings;
}

void show_sweeps(const MappingRun& run, double percent) {
  show_progress(fmt::format("{:3.0f} %, {} sweeps, {:.0f} m, {} million points", percent, run.sweeps().size(),
                            run.sweeps().empty() ? 0.0 : run.sweeps().back().travelled_m,
                            run.map_points() / 1'000'000));
}

void map_capture(const MappingArguments& arguments, const MappingSettings& settings, MappingRun& run) {
  CaptureInput input = arguments.capture;
  input.options.min_range_m = settings.limits.min_m;
  input.options.max_range_m = settings.limits.max_m;
  DecodedCapture capture(std::move(input));
  (void)capture.read([&](const drivers::Sweep& sweep) {
    if (!sweep.complete()) return;
    run.add(sweep);
    show_sweeps(run, capture.percent_read());
  });
}

/// The times of the scans: those of the file, or as if there had been ten a second.
[[nodiscard]] std::vector<std::int64_t> stamps_of(const MappingArguments& arguments, std::size_t scans) {
  constexpr std::int64_t kPeriod_ns = 100'000'000;
  std::vector<std::int64_t> stamps_ns;
  if (arguments.stamps.empty()) {
    for (std::size_t i = 0; i < scans; ++i) stamps_ns.push_back(static_cast<std::int64_t>(i) * kPeriod_ns);
    return stamps_ns;
  }
  for (const auto& stamped : platform::read_tum(arguments.stamps)) stamps_ns.push_back(stamped.stamp_utc_ns);
  if (stamps_ns.size() != scans) {
    throw UsageError(
        fmt::format("{} has {} scans, {} has {} poses: they go together in order, so their numbers "
                    "must agree",
                    arguments.scans, scans, arguments.stamps, stamps_ns.size()));
  }
  return stamps_ns;
}

void map_scans(const MappingArguments& arguments, const MappingSettings& settings, MappingRun& run) {
  const auto scans = list_clouds(arguments.scans);
  const auto stamps_ns = stamps_of(arguments, scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    run.add(load_scan(scans[i], settings.limits), stamps_ns[i]);
    show_sweeps(run, 100.0 * static_cast<double>(i + 1) / static_cast<double>(scans.size()));
  }
}

struct MappingSummary {
  std::size_t added = 0;
  double iterations = 0.0;
  double fitness_score_m2 = 0.0;
  double match_ms = 0.0;
};

/// The first sweep has nothing to be matched to.
[[nodiscard]] MappingSummary summarise(std::span<const MappedSweep> sweeps) {
  MappingSummary sum;
  for (const MappedSweep& sweep : sweeps) {
    sum.added += sweep.added ? 1 : 0;
    sum.iterations += sweep.match.iterations;
    sum.fitness_score_m2 += sweep.fitness_score_m2;
    sum.match_ms += sweep.match_ms;
  }
  const auto matched = static_cast<double>(sweeps.size() - 1);
  sum.iterations /= matched;
  sum.fitness_score_m2 /= matched;
  sum.match_ms /= matched;
  return sum;
}

void make_map(const MappingArguments& arguments) {
  const auto began = std::chrono::steady_clock::now();
  const MappingSettings settings = settings_of(arguments);
  std::filesystem::create_directories(arguments.output);
  MappingRun run(settings, arguments.output);
  (arguments.scans.empty() ? map_capture : map_scans)(arguments, settings, run);
  show_progress("");
  if (run.sweeps().size() < 2)
    throw std::runtime_error("fewer than two whole sweeps: there is nothing to map");
  run.finish();

  const MappingSummary summary = summarise(run.sweeps());
  const double travelled_m = run.sweeps().back().travelled_m;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (arguments.json) {
    const nlohmann::json object{{"sweeps", run.sweeps().size()},
                                {"added", summary.added},
                                {"travelled_m", travelled_m},
                                {"points", run.map_points()},
                                {"iterations_mean", summary.iterations},
                                {"fitness_score_mean", summary.fitness_score_m2},
                                {"match_ms_mean", summary.match_ms},
                                {"seconds", seconds}};
    fmt::print("{}\n", object.dump(2));
    return;
  }
  fmt::print(
      "{} sweeps, {:.1f} m; {} of them made {} points of map.pcd\n{:.1f} iterations a sweep, {:.2f} ms, "
      "fitness score {:.4f} m^2; {:.1f} s in all\n",
      run.sweeps().size(), travelled_m, summary.added, run.map_points(), summary.iterations, summary.match_ms,
      summary.fitness_score_m2, seconds);
}

}  // namespace

void add_mapping_command(CLI::App& app) {
  const auto arguments = std::make_shared<MappingArguments>();
  CLI::App& command = *app.add_subcommand(
      "mapping", "a point map from a drive whose poses are not known, and its trajectory");
  auto* const input = command.add_option_group("what to map");
  auto* const pcap =
      input->add_option("--pcap", arguments->capture.pcap, "a drive's capture")->type_name("FILE");
  auto* const scans =
      input->add_option("--scans", arguments->scans, "a folder of scans in the vehicle frame, in order")
          ->type_name("DIR");
  input->require_option(1);
  command
      .add_option("--sensor", arguments->capture.sensor,
                  "its name (landfix sensors); found out where not given")
      ->needs(pcap)
      ->type_name("NAME");
  command
      .add_option("--calibration", arguments->capture.calibration,
                  "the unit's own file (see landfix sensors)")
      ->needs(pcap)
      ->type_name("FILE");
  add_pose_option(command, "--sensor-pose", arguments->sensor_pose,
                  "of the sensor on the vehicle; identity without it")
      ->needs(pcap);
  command
      .add_option("--stamps", arguments->stamps, "the times of the scans, one a pose; without it 0.1 s apart")
      ->needs(scans)
      ->type_name("A.tum");
  add_pose_option(command, "--initial-pose", arguments->first_pose,
                  "of the first sweep; identity without it");
  command.add_option("--output", arguments->output, "folder for map.pcd, trajectory.tum, metrics.csv")
      ->required()
      ->type_name("DIR");
  MappingSettings& settings = arguments->settings;
  command
      .add_option("--resolution", settings.mapper.resolution_m, "edge of a voxel of what is matched to [m]")
      ->check(in_range(0.1, 20.0))
      ->type_name("M")
      ->capture_default_str();
  command.add_option("--add-after", settings.mapper.add_after_m, "of travel a sweep is added to the map [m]")
      ->check(in_range(0.0, 100.0))
      ->type_name("M")
      ->capture_default_str();
  add_filter_options(command, settings.filter);
  add_range_options(command, settings.limits);
  CLI::Option* const study =
      command.add_flag("--study-settings", arguments->study_settings,
                       "as the reference study did it: sweeps distorted by the motion, 1 m voxels of "
                       "whatever points lie in them,\n"
                       "a 2 m filter, 3 to 200 m, at most 50 iterations, a sweep added after each metre");
  for (const char* const own :
       {"--resolution", "--add-after", "--filter", "--entropy-share", "--leaf", "--min-range", "--max-range"})
    study->excludes(command.get_option(own));
  add_json_option(command, arguments->json);
  command.callback([arguments] { make_map(*arguments); });
}

}  // namespace landfix::tools
