// landfix locate: the pose of a scan without a guess.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "ndt/fit.hpp"
#include "ndt/fitness.hpp"
#include "ndt/plan_view.hpp"
#include "ndt/relocalizer.hpp"
#include "platform/trajectory.hpp"
#include "tools/command.hpp"
#include "tools/cpu_clock.hpp"
#include "tools/input_files.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/locate_run.hpp"
#include "tools/match_report.hpp"

namespace landfix::tools {
namespace {

struct LocateArguments {
  std::string map;
  std::string scan;
  std::string scans;
  std::string truth;
  std::string table;
  std::vector<double> area;  // x, y, radius
  LocateSettings settings;
  bool json = false;
};

[[nodiscard]] nlohmann::json candidates_to_json(const ndt::Location& location) {
  nlohmann::json list = nlohmann::json::array();
  for (const ndt::Candidate& candidate : location.candidates) {
    list.push_back({{"pose", pose_to_json(candidate.match.pose)},
                    {"explained", candidate.match.standing_explained()},
                    {"plan_score", candidate.plan_score}});
  }
  return list;
}

[[nodiscard]] std::string candidates_to_text(const ndt::Location& location) {
  std::string text;
  for (const ndt::Candidate& candidate : location.candidates) {
    const ndt::Pose& pose = candidate.match.pose;
    text += fmt::format("candidate         {:.2f} {:.2f} {:.2f} m, yaw {:.2f} deg: explains {:.1f} %\n",
                        pose.translation().x(), pose.translation().y(), pose.translation().z(),
                        ndt::to_roll_pitch_yaw(pose.linear()).yaw_rad / kRadians_per_deg,
                        100.0 * candidate.match.standing_explained());
  }
  return text;
}

[[nodiscard]] const char* verdict(const ndt::Location& location) {
  if (location.sure) return "sure";
  if (location.candidates.empty())
    return "nothing fits: the map does not show this place, or the scan shows nothing";
  if (!location.complete) return "not sure: the search was cut short; name an --area";
  const ndt::MatchResult& best = location.candidates[0].match;
  if (ndt::judge(best, {}) == ndt::Fit::none) return "not sure: no place explains much of the scan";
  if (best.weak.count != 0) return "not sure: the place fits, but not in every direction";
  return "not sure: too little speaks for it, or another place is as good";
}

void locate_one(const LocateArguments& arguments, const ndt::VoxelMap& map, const ndt::PlanView& plan) {
  const LocateSettings& settings = arguments.settings;
  const auto scan = load_scan(arguments.scan, settings.limits);
  ndt::ScanFilter filter(settings.filter, scan.size());
  filter.add(scan, elevation_steps(scan));
  const auto points_m = filter.finish();
  std::optional<ndt::PoseGuess> area;
  if (!arguments.area.empty())
    area = {.position_m = {arguments.area[0], arguments.area[1]}, .within_m = arguments.area[2]};
  ndt::Relocalizer relocalizer(plan);
  ndt::Location location;
  const double cpu_ms = cpu_ms_of([&] { location = relocalizer.locate(map, points_m, area); });

  const ndt::MatchResult best = location.candidates.empty() ? ndt::MatchResult{.points = points_m.size()}
                                                            : location.candidates[0].match;
  const double fitness_score = ndt::FitnessScore(map)(points_m, best.pose);
  if (arguments.json) {
    nlohmann::json object = match_to_json(best, fitness_score, cpu_ms);
    object["sure"] = location.sure;
    object["confidence"] = location.confidence;
    object["complete"] = location.complete;
    object["candidates"] = candidates_to_json(location);
    object["seconds"] = 1e-3 * cpu_ms;
    fmt::print("{}\n", object.dump(2));
    return;
  }
  if (ndt::judge(best, {}) != ndt::Fit::none) fmt::print("{}", match_to_text(best, fitness_score, cpu_ms));
  fmt::print("{}verdict           {} (confidence {:.4f})\n", candidates_to_text(location), verdict(location),
             location.confidence);
}

void locate_many(const LocateArguments& arguments, const ndt::VoxelMap& map, const ndt::PlanView& plan) {
  const auto scans = list_clouds(arguments.scans);
  const auto truth = platform::read_tum(arguments.truth);
  if (truth.size() != scans.size()) {
    throw UsageError(fmt::format(
        "{} has {} scans, {} has {} poses: they go together in order, so their numbers must agree",
        arguments.scans, scans.size(), arguments.truth, truth.size()));
  }
  const auto located = locate_all(map, plan, scans, truth, arguments.settings);
  if (!arguments.table.empty()) write_table(arguments.table, located);
  fmt::print("{}", arguments.json ? to_json(located, plan).dump(2) + "\n" : to_text(located, plan));
}

void locate(const LocateArguments& arguments) {
  constexpr double kFarthest_m = 1e7;
  const auto is_place = [](double metres) { return std::abs(metres) <= kFarthest_m; };
  if (!arguments.area.empty() && !(std::ranges::all_of(arguments.area, is_place) && arguments.area[2] > 0.0))
    throw UsageError("--area: X,Y,RADIUS, three numbers up to 10,000 km, the radius above 0");
  const ndt::MapImage image = load_map_file(arguments.map);
  const ndt::VoxelMap map(image.bytes());
  const ndt::PlanView plan(map);
  (arguments.scan.empty() ? locate_many : locate_one)(arguments, map, plan);
}

}  // namespace

void add_locate_command(CLI::App& app) {
  const auto arguments = std::make_shared<LocateArguments>();
  LocateSettings& settings = arguments->settings;
  CLI::App& command = *app.add_subcommand(
      "locate", "the pose of a scan without a guess, anywhere on a map; how often that is right");
  command.add_option("--map", arguments->map, "map, made by landfix map")->required()->type_name("MAP.ndt");
  auto* const input = command.add_option_group("what to locate");
  auto* const scan =
      input->add_option("--scan", arguments->scan, "one scan in the vehicle frame")->type_name("SCAN.pcd");
  auto* const scans =
      input->add_option("--scans", arguments->scans, "a folder of them, to measure how often it is right")
          ->type_name("DIR");
  input->require_option(1);
  command
      .add_option(
          "--area", arguments->area,
          "look within so far of a place, in the frame of the map [m]; anywhere without it, and only where\n"
          "the map has ground, which is level with the origin of the scan's frame")
      ->delimiter(',')
      ->expected(3)
      ->needs(scan)
      ->type_name("X,Y,RADIUS");
  auto* const truth =
      command.add_option("--truth", arguments->truth, "a pose for each scan of --scans, in the same order")
          ->needs(scans)
          ->type_name("TRUTH.tum");
  scans->needs(truth);
  command.add_option("--every", settings.every, "of the scans, the first and then each so many")
      ->needs(scans)
      ->check(in_range(std::size_t{1}, std::size_t{1'000'000}))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--within", settings.within_m, "look within so far of each scan's true place [m]")
      ->needs(scans)
      ->check(in_range(1e-9, 1e9))
      ->type_name("M");
  command.add_option("--table", arguments->table, "write a line a scan, as CSV")
      ->needs(scans)
      ->type_name("OUT.csv");
  add_filter_options(command, settings.filter);
  add_range_options(command, settings.limits);
  add_json_option(command, arguments->json);
  command.callback([arguments] { locate(*arguments); });
}

}  // namespace landfix::tools
