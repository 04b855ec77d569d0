// The commands of `landfix`, in the order in which --help lists them.
#pragma once

#include <span>

#include "tools/command.hpp"

namespace landfix::tools {

void add_sensors_command(CLI::App& app);
void add_decode_command(CLI::App& app);
void add_map_command(CLI::App& app);
void add_mapping_command(CLI::App& app);
void add_align_command(CLI::App& app);
void add_locate_command(CLI::App& app);
void add_benchmark_command(CLI::App& app);
void add_replay_command(CLI::App& app);
void add_play_command(CLI::App& app);
void add_latency_command(CLI::App& app);
void add_top_command(CLI::App& app);
void add_can_command(CLI::App& app);
void add_quality_command(CLI::App& app);
void add_evaluate_command(CLI::App& app);
void add_simulate_command(CLI::App& app);
void add_study_command(CLI::App& app);
void add_doctor_command(CLI::App& app);

extern const std::span<const AddCommand> kCommands;

}  // namespace landfix::tools
