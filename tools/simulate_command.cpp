// landfix simulate: a drive with its capture, truth, map and configuration.
#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/command.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/simulator/simulation.hpp"

namespace landfix::tools {
namespace {

struct Arguments {
  std::string route;
  std::string sensor;
  std::string output;
  std::optional<std::uint64_t> seed;
  std::optional<double> length_m;
  bool json = false;
};

simulator::Route choose_route(const Arguments& arguments) {
  try {
    simulator::Route route = simulator::load_route(arguments.route);
    return arguments.length_m ? simulator::shortened(std::move(route), *arguments.length_m) : route;
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

void simulate(const Arguments& arguments) {
  if (arguments.sensor != "vlp16") {
    throw UsageError(fmt::format("the simulator has no sensor '{}'; available: vlp16", arguments.sensor));
  }
  const simulator::Route route = choose_route(arguments);
  const std::uint64_t seed = arguments.seed.value_or(route.seed);
  const auto start = std::chrono::steady_clock::now();
  const simulator::Drive drive(route, seed);
  const simulator::SimulationSummary summary =
      simulator::write_drive(drive, arguments.output, [](double share) {
        show_progress(share < 1.0 ? fmt::format("simulating: {:3.0f} %", 100.0 * share) : "");
      });
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;

  if (arguments.json) {
    const nlohmann::ordered_json json = {
        {"route", route.name},
        {"sensor", arguments.sensor},
        {"seed", seed},
        {"length_m", summary.length_m},
        {"duration_s", summary.duration_s},
        {"packets", {{"data", summary.data_packets}, {"position", summary.position_packets}}},
        {"returns", summary.returns},
        {"map_points", summary.map_points},
        {"seconds", took.count()}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print(
      "route {}, seed {}: {:.1f} m in {:.1f} s\n{}: {} data packets, {} position packets, {} returns\n"
      "surveyed map: {} points\nwritten to {} in {:.1f} s\n",
      route.name, seed, summary.length_m, summary.duration_s, arguments.sensor, summary.data_packets,
      summary.position_packets, summary.returns, summary.map_points, arguments.output, took.count());
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command =
      app.add_subcommand("simulate", "a drive with its capture, truth, surveyed map and configuration");
  std::string names;
  for (const std::string& name : simulator::route_names()) names += name + ", ";
  command->add_option("--route", arguments->route, names + "or a TOML file")->required();
  command->add_option("--sensor", arguments->sensor, "vlp16")->required();
  command
      ->add_option("--output", arguments->output, "folder for capture.pcap, truth.tum, map.pcd, config.toml")
      ->required();
  command->add_option("--seed", arguments->seed, "another world and other noise; by default the route's");
  command->add_option("--length", arguments->length_m, "metres to drive; by default the whole route");
  add_json_option(*command, arguments->json);
  command->callback([arguments] { simulate(*arguments); });
}

}  // namespace landfix::tools
