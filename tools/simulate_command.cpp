// landfix simulate: a drive with its capture, truth, map and configuration.
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "tools/command.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/simulator/simulation.hpp"
#include "tools/simulator/still_scans.hpp"

namespace landfix::tools {
namespace {

struct SimulateArguments {
  std::string route;
  std::string sensor;
  std::string output;
  std::optional<std::uint64_t> seed;
  std::optional<double> length_m;
  std::uint64_t unit = 0;
  bool scans = false;
  bool json = false;
};

std::unique_ptr<simulator::Drive> make_drive(const SimulateArguments& arguments) {
  try {
    simulator::Route route = simulator::load_route(arguments.route);
    if (arguments.length_m) route = simulator::shortened(std::move(route), *arguments.length_m);
    const std::uint64_t seed = arguments.seed.value_or(route.seed);
    return std::make_unique<simulator::Drive>(std::move(route), seed, arguments.sensor, arguments.unit);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

void simulate(const SimulateArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const std::unique_ptr<simulator::Drive> drive = make_drive(arguments);
  const auto progress = [](double share) {
    show_progress(share < 1.0 ? fmt::format("simulating: {:3.0f} %", 100.0 * share) : "");
  };
  const simulator::SimulationSummary summary = simulator::write_drive(*drive, arguments.output, progress);
  if (arguments.scans) simulator::write_still_scans(*drive, arguments.output, progress);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;

  if (arguments.json) {
    const nlohmann::ordered_json json = {
        {"route", drive->route().name},
        {"sensor", arguments.sensor},
        {"seed", drive->seed()},
        {"unit", drive->unit()},
        {"length_m", summary.length_m},
        {"duration_s", summary.duration_s},
        {"packets", {{"data", summary.data_packets}, {"telemetry", summary.telemetry_packets}}},
        {"returns", summary.returns},
        {"map_points", summary.map_points},
        {"seconds", took.count()}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print(
      "route {}, seed {}: {:.1f} m in {:.1f} s\n{}: {} data packets, {} telemetry packets, {} returns\n"
      "surveyed map: {} points\nwritten to {} in {:.1f} s\n",
      drive->route().name, drive->seed(), summary.length_m, summary.duration_s, arguments.sensor,
      summary.data_packets, summary.telemetry_packets, summary.returns, summary.map_points, arguments.output,
      took.count());
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  const auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* const command =
      app.add_subcommand("simulate", "a drive with its capture, truth, surveyed map and configuration");
  command
      ->add_option("--route", arguments->route,
                   fmt::format("{}, or a TOML file; those of config/routes explain the keys",
                               fmt::join(simulator::route_names(), ", ")))
      ->required();
  command
      ->add_option("--sensor", arguments->sensor,
                   fmt::format("{}", fmt::join(simulator::lidar_model_names(), ", ")))
      ->required();
  command
      ->add_option("--output", arguments->output,
                   "folder for capture.pcap, truth.tum, odometry.log, map.pcd, map_projector_info.yaml, "
                   "config.toml, calibration")
      ->required();
  command->add_option("--seed", arguments->seed, "another world and other noise; by default the route's");
  command
      ->add_option(
          "--unit", arguments->unit,
          "which unit of the sensor, each with errors of its own, which decoders do not know, of where "
          "its lasers point and how far they measure; 0 has none")
      ->capture_default_str();
  command->add_option("--length", arguments->length_m,
                      "metres to drive; by default the whole route. A city is surveyed whole");
  command->add_flag("--scans", arguments->scans,
                    "also what the sensor would see standing still at the end of each turn, in the vehicle's "
                    "frame: scans/, and where that is: scans.tum");
  add_json_option(*command, arguments->json);
  command->callback([arguments] { simulate(*arguments); });
}

}  // namespace landfix::tools
