#include "tools/landfix_commands.hpp"

#include <array>

namespace landfix::tools {
namespace {

constexpr std::array kTable{
    add_sensors_command,    //
    add_decode_command,     //
    add_map_command,        //
    add_mapping_command,    //
    add_align_command,      //
    add_locate_command,     //
    add_benchmark_command,  //
    add_replay_command,     //
    add_play_command,       //
    add_latency_command,    //
    add_top_command,        //
    add_can_command,        //
    add_quality_command,    //
    add_evaluate_command,   //
    add_simulate_command,   //
    add_study_command,      //
    add_doctor_command,     //
};

}  // namespace

const std::span<const AddCommand> kCommands = kTable;

}  // namespace landfix::tools
