// landfix latency: stage by stage, against a budget.
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "platform/hgrm.hpp"
#include "platform/stage.hpp"
#include "tools/command.hpp"
#include "tools/daemon_status.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/latency_table.hpp"

namespace landfix::tools {
namespace {

struct LatencyArguments {
  std::vector<std::string> files;
  bool live = false;
  DaemonAddress daemon;
  std::string budget;
  bool json = false;
};

/// The file, and those of other stages that were written with it.
void read_file_and_stages(const std::filesystem::path& path, std::vector<StageLatency>& stages) {
  for (const std::string_view stage : platform::kStageNames) {
    const std::filesystem::path beside = platform::hgrm_of_stage(path, stage);
    if (!std::filesystem::exists(beside)) continue;
    stages.push_back(latency_of(platform::read_hgrm(beside)));
    if (stages.back().stage.empty()) stages.back().stage = stage;
  }
  stages.push_back(latency_of(platform::read_hgrm(path)));
  if (stages.back().stage.empty()) stages.back().stage = path.stem().string();
}

/// Of the running daemon, since its start.
void read_live(const DaemonAddress& daemon, std::vector<StageLatency>& stages) {
  const nlohmann::json status = daemon_status(daemon);
  for (const auto& [name, stage] : status.at("stage_ms").items()) {
    StageLatency latency{.stage = name, .count = stage.at("count"), .values_ms = {}};
    for (std::size_t i = 0; i < kLatencyKeys.size(); ++i) {
      latency.values_ms[i] = stage.at(std::string(kLatencyKeys[i]));
    }
    stages.push_back(latency);
  }
  std::ranges::sort(stages, {}, [](const StageLatency& latency) {  // as a pose goes through them
    return std::ranges::find(platform::kStageNames, latency.stage) - platform::kStageNames.begin();
  });
}

void latency(const LatencyArguments& arguments) {
  if (arguments.files.empty() != arguments.live) {
    throw UsageError("either .hgrm files, or --live of the running daemon");
  }
  std::vector<StageLatency> stages;
  if (arguments.live) read_live(arguments.daemon, stages);
  for (const std::string& file : arguments.files) read_file_and_stages(file, stages);
  const LatencyBudget budget = arguments.budget.empty() ? default_budget() : read_budget(arguments.budget);
  fmt::print("{}", arguments.json ? to_json(stages, budget).dump(2) + "\n" : to_table(stages, budget));
}

}  // namespace

void add_latency_command(CLI::App& app) {
  const auto arguments = std::make_shared<LatencyArguments>();
  CLI::App& command = *app.add_subcommand("latency", "latencies stage by stage, against a budget");
  command
      .add_option("FILE", arguments->files,
                  ".hgrm of landfix replay --latency, with the stages beside it; or of another program")
      ->type_name("");
  command.add_flag("--live", arguments->live, "of the running daemon, since its start");
  add_daemon_options(command, arguments->daemon);
  command
      .add_option(
          "--budget", arguments->budget,
          "limits, TOML: a section a stage with p50_ms, p90_ms, p99_ms, p999_ms, max_ms; else landfix's own")
      ->type_name("FILE");
  add_json_option(command, arguments->json);
  command.callback([arguments] { latency(*arguments); });
}

}  // namespace landfix::tools
