// landfix align: the pose of one scan from a guess.
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "ndt/fitness.hpp"
#include "ndt/matcher.hpp"
#include "ndt/scan_filter.hpp"
#include "tools/command.hpp"
#include "tools/input_files.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/match_report.hpp"

namespace landfix::tools {
namespace {

struct AlignArguments {
  std::string map;
  std::string scan;
  std::optional<ndt::Pose> guess;
  ndt::FilterSettings filter;
  RangeLimits limits;
  bool json = false;
};

void align(const AlignArguments& arguments) {
  const ndt::MapImage image = load_map_file(arguments.map);
  const ndt::VoxelMap map(image.bytes());
  const auto scan = load_scan(arguments.scan, arguments.limits);
  if (scan.empty()) {
    throw std::runtime_error(
        fmt::format("{}: no point between {} m and {} m of the origin; see --min-range, --max-range",
                    arguments.scan, arguments.limits.min_m, arguments.limits.max_m));
  }
  ndt::ScanFilter filter(arguments.filter, scan.size());
  filter.add(scan, elevation_steps(scan));
  const auto points_m = filter.finish();

  ndt::Matcher matcher({}, points_m.size());
  const auto began = std::chrono::steady_clock::now();
  const ndt::MatchResult result = matcher.match(map, points_m, arguments.guess.value());
  const double match_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
  const double fitness_score = ndt::FitnessScore(map)(points_m, result.pose);
  fmt::print("{}", arguments.json ? match_to_json(result, fitness_score, match_ms).dump(2) + "\n"
                                  : match_to_text(result, fitness_score, match_ms));
}

}  // namespace

void add_align_command(CLI::App& app) {
  const auto arguments = std::make_shared<AlignArguments>();
  CLI::App& command =
      *app.add_subcommand("align", "the pose of one scan, from a guess, and whether it is to be believed");
  command.add_option("--map", arguments->map, "map, made by landfix map")->required()->type_name("MAP.ndt");
  command.add_option("--scan", arguments->scan, "scan in the vehicle frame")
      ->required()
      ->type_name("SCAN.pcd");
  add_pose_option(command, "--guess", arguments->guess, "pose to start from, map <- vehicle [m, deg]")
      ->required();
  add_filter_options(command, arguments->filter);
  add_range_options(command, arguments->limits);
  add_json_option(command, arguments->json);
  command.callback([arguments] { align(*arguments); });
}

}  // namespace landfix::tools
