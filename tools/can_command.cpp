// landfix can: the poses in a log of CAN frames or on a bus, and the description of the frames.
#include <memory>

#include <fmt/format.h>

#include "platform/frame_description.hpp"
#include "platform/pose_frame_table.hpp"
#include "tools/can_decode.hpp"
#include "tools/command.hpp"
#include "tools/landfix_commands.hpp"

namespace landfix::tools {
namespace {

void add_base_id(CLI::App& command, std::uint32_t& base_id) {
  command.add_option("--base-id", base_id, "identifier of the first frame, as [can] base_id")
      ->check(in_range(std::uint32_t{1}, platform::kMaxBaseId))
      ->type_name("ID")
      ->default_str(fmt::format("0x{:X}", base_id));
}

void add_decode(CLI::App& can) {
  const auto arguments = std::make_shared<CanDecodeArguments>();
  CLI::App& decode =
      *can.add_subcommand("decode", "poses from a log of candump or from an interface, protection checked");
  decode
      .add_option("LOG|INTERFACE", arguments->source,
                  "log, as candump -l and landfix replay --candump write it; or interface, until Ctrl-C")
      ->type_name("")
      ->required();
  decode
      .add_option("--interface", arguments->interface, "of the log's; else the first with a frame of a pose")
      ->type_name("NAME");
  add_base_id(decode, arguments->base_id);
  decode.add_option("--count", arguments->count, "end after so many poses")->type_name("N");
  decode.add_option("--seconds", arguments->seconds, "of an interface: end after this time")
      ->check(in_range(0.0, 1e9))
      ->type_name("S");
  add_json_option(decode, arguments->json);
  decode.callback([arguments] { decode_can(*arguments); });
}

}  // namespace

void add_can_command(CLI::App& app) {
  CLI::App& can = *app.add_subcommand("can", "the CAN frames of poses: decode them, describe them");
  can.require_subcommand(1);
  add_decode(can);

  const auto base_id = std::make_shared<std::uint32_t>(platform::CanSettings{}.base_id);
  CLI::App& dbc = *can.add_subcommand("dbc", "print the frames as a DBC file (config/landfix.dbc)");
  add_base_id(dbc, *base_id);
  dbc.callback([base_id] { fmt::print("{}", platform::to_dbc(*base_id)); });

  CLI::App& table = *can.add_subcommand("table", "print the frames as a table in Markdown");
  table.callback([] { fmt::print("{}", platform::to_markdown()); });
}

}  // namespace landfix::tools
