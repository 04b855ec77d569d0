// landfix can: the poses in a log of CAN frames, and the description of the frames.
#include <array>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "platform/candump_log.hpp"
#include "platform/configuration.hpp"
#include "platform/frame_description.hpp"
#include "platform/pose_frame_decoder.hpp"
#include "tools/can_report.hpp"
#include "tools/command.hpp"
#include "tools/landfix_commands.hpp"

namespace landfix::tools {
namespace {

struct Arguments {
  std::string log;
  std::string interface;  ///< empty: the first with one of our frames
  std::uint32_t base_id = platform::CanSettings{}.base_id;
  bool json = false;
};

struct Counts {
  std::uint64_t lines_skipped = 0;  ///< empty, remote frames, no frames at all
  std::uint64_t frames = 0;
  std::uint64_t frames_ours = 0;
  std::uint64_t frames_elsewhere = 0;  ///< ours by their identifier, on another interface
  std::uint64_t poses = 0;
  std::array<std::uint64_t, kCanFaultKinds> faults{};

  [[nodiscard]] std::uint64_t of(CanFaultKind kind) const { return faults[static_cast<std::size_t>(kind)]; }
};

/// Takes what is found, in the order of the log.
class Output {
 public:
  explicit Output(bool json) : json_(json) {}

  void add(const platform::PoseReport& pose) {
    if (++counts.poses == 1 && !json_) fmt::print("{}", pose_title());
    if (json_)
      poses_.push_back(to_json(pose));
    else
      fmt::print("{}", to_line(pose));
  }
  void add(const CanFault& fault) {
    ++counts.faults[static_cast<std::size_t>(fault.kind)];
    if (json_)
      faults_.push_back(to_json(fault));
    else
      fmt::print("{}", to_line(fault));
  }
  void finish() const {
    if (json_)
      print_json();
    else
      print_summary();
  }

  Counts counts;

 private:
  void print_json() const {
    nlohmann::ordered_json kinds;
    for (std::size_t i = 0; i < kCanFaultKinds; ++i) {
      kinds[std::string(to_string(static_cast<CanFaultKind>(i)))] = counts.faults[i];
    }
    const nlohmann::ordered_json object{{"frames",
                                         {{"total", counts.frames},
                                          {"decoded", counts.frames_ours},
                                          {"other_interfaces", counts.frames_elsewhere},
                                          {"lines_skipped", counts.lines_skipped}}},
                                        {"fault_counts", kinds},
                                        {"faults", faults_},
                                        {"poses", poses_}};
    fmt::print("{}\n", object.dump(2));
  }

  void print_summary() const {
    std::string faults;
    for (std::size_t i = 0; i < kCanFaultKinds; ++i) {
      if (counts.faults[i] == 0) continue;
      faults += fmt::format("{}{} x {}", faults.empty() ? "" : ", ", counts.faults[i],
                            to_string(static_cast<CanFaultKind>(i)));
    }
    fmt::print("{} poses in {} frames of {}; faults: {}\n", counts.poses, counts.frames_ours, counts.frames,
               faults.empty() ? "none" : faults);
  }

  bool json_;
  nlohmann::ordered_json poses_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json faults_ = nlohmann::ordered_json::array();
};

[[nodiscard]] std::ifstream open_log(const std::string& path) {
  std::ifstream log(path);
  if (!log) {
    throw std::runtime_error(fmt::format(
        "{}: cannot be read as a log; of an interface: candump -L can0 | landfix can decode /dev/stdin",
        path));
  }
  return log;
}

void read_log(std::ifstream& log, const Arguments& arguments, Output& output) {
  platform::PoseFrameDecoder decoder(arguments.base_id);
  std::string interface = arguments.interface;
  std::int64_t last_utc_ns = 0;
  std::array<char, 512> line;  // a frame is shorter; what is longer is cut, and no frame
  while (log.getline(line.data(), line.size()) || log.gcount() != 0) {
    if (log.fail() && !log.eof()) log.clear();
    const auto logged = platform::parse_candump_line(line.data());
    if (!logged) {
      ++output.counts.lines_skipped;
      continue;
    }
    ++output.counts.frames;
    if (decoder.layout_of(logged->frame) == nullptr) continue;
    if (interface.empty()) interface = logged->interface;
    if (logged->interface != interface) {
      ++output.counts.frames_elsewhere;
      continue;
    }
    ++output.counts.frames_ours;
    last_utc_ns = logged->stamp_utc_ns;
    const platform::DecodedFrame decoded = decoder.decode(logged->frame, logged->stamp_utc_ns);
    for (const CanFault& fault : faults_of(decoded, logged->stamp_utc_ns)) output.add(fault);
    if (decoded.pose) output.add(*decoded.pose);
  }
  if (decoder.frames_missing() != 0) output.add(end_of_log_fault(decoder.frames_missing(), last_utc_ns));
}

void decode(const Arguments& arguments) {
  std::ifstream log = open_log(arguments.log);
  Output output(arguments.json);
  read_log(log, arguments, output);
  const Counts& counts = output.counts;
  if (counts.frames_ours == 0) {
    throw std::runtime_error(fmt::format(
        "{}: no pose at base id 0x{:X}{} among {} frames, {} lines are none; choose with --base-id, "
        "--interface",
        arguments.log, arguments.base_id, arguments.interface.empty() ? "" : " on " + arguments.interface,
        counts.frames, counts.lines_skipped));
  }
  if (counts.frames_elsewhere != 0) {
    fmt::print(stderr, "landfix: {} pose frames on other interfaces were left out; choose with --interface\n",
               counts.frames_elsewhere);
  }
  output.finish();
}

void add_base_id(CLI::App& command, Arguments& arguments) {
  command.add_option("--base-id", arguments.base_id, "identifier of the first frame, as [can] base_id")
      ->check(CLI::Range(std::uint32_t{1}, platform::kMaxBaseId).description(""))
      ->type_name("ID")
      ->default_str(fmt::format("0x{:X}", arguments.base_id));
}

}  // namespace

void add_can_command(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& can = *app.add_subcommand("can", "the CAN frames of poses: decode a log, describe them");
  can.require_subcommand(1);

  CLI::App& decode_log = *can.add_subcommand("decode", "poses from a log of candump, protection checked");
  decode_log.add_option("LOG", arguments->log, "as candump -l and landfix replay --candump write it")
      ->type_name("")
      ->required();
  decode_log
      .add_option("--interface", arguments->interface, "of the log's; else the first with a frame of a pose")
      ->type_name("NAME");
  add_base_id(decode_log, *arguments);
  add_json_option(decode_log, arguments->json);
  decode_log.callback([arguments] { decode(*arguments); });

  CLI::App& dbc = *can.add_subcommand("dbc", "print the frames as a DBC file (config/landfix.dbc)");
  add_base_id(dbc, *arguments);
  dbc.callback([arguments] { fmt::print("{}", platform::to_dbc(arguments->base_id)); });

  CLI::App& table = *can.add_subcommand("table", "print the frames as a table in Markdown");
  table.callback([] { fmt::print("{}", platform::to_markdown()); });
}

}  // namespace landfix::tools
