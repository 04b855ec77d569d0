// landfix study: ten sensors on three routes, mapped and localized, as tables and pictures.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "platform/atomic_file.hpp"
#include "tools/command.hpp"
#include "tools/command_line.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/simulator/lidar_model.hpp"
#include "tools/simulator/route.hpp"
#include "tools/study/page.hpp"
#include "tools/study/study_run.hpp"
#include "tools/study/tables.hpp"

namespace landfix::tools {
namespace {

/// The reference study's, in its order.
const std::vector<std::string> kStudySensors{"vls128ap", "vls128",   "hdl64s2",   "hdl32e", "vlp32c",
                                             "vlp16",    "pandar64", "pandar40p", "os1-64", "rs32"};
const std::vector<std::string> kStudyRoutes{"A", "B", "C"};

struct StudyArguments {
  std::filesystem::path folder;
  std::size_t at_once = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::string> routes = kStudyRoutes;
  std::vector<std::string> sensors = kStudySensors;
  double length_m = 0.0;
  std::string ablations = "first";
  bool tune = false;
  bool keep = false;
  bool json = false;
  std::string command;
};

/// Throws UsageError for what cannot be driven: before hours of work, not after them.
void check_cases(const StudyArguments& arguments) {
  try {
    for (const std::string& name : arguments.routes) {
      simulator::Route route = simulator::load_route(name);
      if (arguments.length_m != 0.0) (void)simulator::shortened(std::move(route), arguments.length_m);
    }
    for (const std::string& sensor : arguments.sensors) (void)simulator::make_lidar_model(sensor);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

[[nodiscard]] std::vector<study::Case> cases_of(const StudyArguments& arguments) {
  std::vector<study::Case> cases;
  std::set<std::string> names;
  for (const std::string& route : arguments.routes) {
    for (const std::string& sensor : arguments.sensors) {
      const bool ablate = arguments.ablations == "all" ||
                          (arguments.ablations == "first" && route == arguments.routes.front());
      cases.push_back({.route = route,
                       .sensor = sensor,
                       .length_m = arguments.length_m,
                       .ablate = ablate,
                       .tune = arguments.tune,
                       .keep = arguments.keep});
      if (!names.insert(cases.back().name()).second)
        throw UsageError(fmt::format("{} would be done twice, in one folder", cases.back().name()));
    }
  }
  return cases;
}

[[nodiscard]] std::string line_of(const study::CaseResult& result) {
  if (!result.figures) return fmt::format("{:<14} failed: {}", result.one.name(), result.error);
  const study::CaseFigures& figures = *result.figures;
  return fmt::format(
      "{:<14} {:4.0f} s{}  localized to {:.1f} cm, {:.3f} deg, {} lost; elevation mapped to {:.2f} m, by the "
      "study's settings {:.2f} m",
      result.one.name(), figures.seconds, result.is_old ? " before" : "",
      100.0 * figures.localization.position_rmse_m, figures.localization.heading_rmse_deg,
      figures.localization.lost, figures.by_landfix.elevation_max_m, figures.by_study.elevation_max_m);
}

/// Without what happened along the way, which is in along.csv.
[[nodiscard]] nlohmann::ordered_json json_of(std::span<const study::CaseResult> results) {
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
  for (const study::CaseResult& result : results) {
    nlohmann::ordered_json run{{"route", result.one.route}, {"sensor", result.one.sensor}};
    if (result.figures) {
      run["figures"] = nlohmann::json(*result.figures);
      for (const char* const part : {"by_landfix", "by_study", "localization"})
        run["figures"][part].erase("along");
    } else {
      run["error"] = result.error;
    }
    runs.push_back(std::move(run));
  }
  return runs;
}

[[nodiscard]] std::vector<study::CaseResult> run_cases(const StudyArguments& arguments,
                                                       const std::vector<study::Case>& cases) {
  std::size_t done = 0;
  return study::run_cases(cases, arguments.folder, arguments.at_once,
                          {.on_result =
                               [&](const study::CaseResult& result) {
                                 ++done;
                                 show_progress("");
                                 if (arguments.json) return;
                                 fmt::print("{}\n", line_of(result));
                                 std::fflush(stdout);
                               },
                           .on_wait =
                               [&](std::span<const std::string> names) {
                                 show_progress(fmt::format("{} of {} done; at work: {}", done, cases.size(),
                                                           fmt::join(names, ", ")));
                               }});
}

void run_study(const StudyArguments& arguments) {
  check_cases(arguments);
  const auto began = std::chrono::steady_clock::now();
  const std::vector<study::Case> cases = cases_of(arguments);
  std::filesystem::create_directories(arguments.folder);
  const auto results = run_cases(arguments, cases);
  show_progress("");
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  const auto failed = std::ranges::count_if(results, [](const auto& result) { return !result.figures; });
  const std::filesystem::path page = arguments.folder / "index.html";
  study::write_tables(results, arguments.folder);
  platform::write_file(page, study::to_html({.results = results,
                                             .seconds = seconds,
                                             .command = arguments.command,
                                             .version = LANDFIX_VERSION}));
  if (arguments.json) {
    const nlohmann::ordered_json object{{"runs", json_of(results)}, {"failed", failed}, {"seconds", seconds}};
    fmt::print("{}\n", object.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    fmt::print("{} runs in {:.0f} s; open {}\n", cases.size(), seconds, page.string());
  }
  if (failed != 0)
    throw std::runtime_error(fmt::format("{} of {} runs failed; the page says why", failed, cases.size()));
}

}  // namespace

void add_study_command(CLI::App& app) {
  const auto arguments = std::make_shared<StudyArguments>();
  CLI::App& command = *app.add_subcommand(
      "study", "sensors on routes: simulated, mapped and localized, as tables and pictures");
  command
      .add_option(
          "--output", arguments->folder,
          "folder for index.html, the tables and a folder a run; runs that are done there are not done again")
      ->required()
      ->type_name("DIR");
  command.add_option("--routes", arguments->routes, "of the simulator, or TOML files")
      ->delimiter(',')
      ->type_name("A,B,...")
      ->capture_default_str();
  command.add_option("--sensors", arguments->sensors, "of the simulator")
      ->delimiter(',')
      ->type_name("A,B,...")
      ->capture_default_str();
  command
      .add_option("--length", arguments->length_m, "of each route, from its start [m]; 0: the whole of it")
      ->check(in_range(0.0, 1e6))
      ->type_name("M")
      ->capture_default_str();
  command
      .add_option("--ablations", arguments->ablations,
                  "localize with one thing after the other set otherwise: on no route, the first, or all")
      ->check(CLI::IsMember({"none", "first", "all"}).description(""))
      ->type_name("none|first|all")
      ->capture_default_str();
  command.add_flag(
      "--tune", arguments->tune,
      "look for leaf, resolution and range, too: the fastest of 24 that are nearly as good as the "
      "best, as tuned.toml");
  command.add_option("--jobs", arguments->at_once, "runs at once")
      ->check(in_range(std::size_t{1}, std::size_t{64}))
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("--keep", arguments->keep, "keep captures and clouds, some GB each");
  add_json_option(command, arguments->json);
  command.callback([arguments, &command] {
    arguments->command = command_line(command);
    run_study(*arguments);
  });
}

}  // namespace landfix::tools
