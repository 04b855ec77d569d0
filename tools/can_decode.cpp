#include "tools/can_decode.hpp"

#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <poll.h>

#include "platform/bus_message.hpp"
#include "platform/can_receiver.hpp"
#include "platform/candump_log.hpp"
#include "platform/monotonic_clock.hpp"
#include "platform/pose_frame_decoder.hpp"
#include "tools/can_report.hpp"

namespace landfix::tools {
namespace {

using Arguments = CanDecodeArguments;

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
  void add_geodetic(const platform::PoseReport& place) {
    if (json_)
      geodetic_.push_back(to_json_geodetic(place));
    else
      fmt::print("{}", to_line_geodetic(place));
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
                                        {"poses", poses_},
                                        {"geodetic", geodetic_}};
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
  nlohmann::ordered_json geodetic_ = nlohmann::ordered_json::array();
};

/// Frames of one bus, in their order.
class Reader {
 public:
  Reader(const Arguments& arguments, Output& output)
      : decoder_(arguments.base_id), output_(output), most_poses_(arguments.count) {}

  [[nodiscard]] bool is_ours(const platform::CanFrame& frame) const {
    return decoder_.layout_of(frame) != nullptr;
  }
  void take(const platform::CanFrame& frame, std::int64_t stamp_utc_ns) {
    ++output_.counts.frames_ours;
    last_utc_ns_ = stamp_utc_ns;
    const platform::DecodedFrame decoded = decoder_.decode(frame, stamp_utc_ns);
    for (const CanFault& fault : faults_of(decoded, stamp_utc_ns)) output_.add(fault);
    if (decoded.pose) output_.add(*decoded.pose);
    if (decoded.geodetic) output_.add_geodetic(*decoded.geodetic);
  }
  [[nodiscard]] bool has_enough() const { return most_poses_ != 0 && output_.counts.poses >= most_poses_; }
  /// A pose that is begun when the frames end is a fault, unless it was not waited for.
  void finish() {
    if (decoder_.frames_missing() != 0 && !has_enough())
      output_.add(end_of_log_fault(decoder_.frames_missing(), last_utc_ns_));
  }

 private:
  platform::PoseFrameDecoder decoder_;
  Output& output_;
  std::uint64_t most_poses_;
  std::int64_t last_utc_ns_ = 0;
};

[[nodiscard]] std::ifstream open_log(const std::string& path) {
  std::ifstream log(path);
  if (!log) throw std::runtime_error(fmt::format("{}: cannot be read as a log", path));
  return log;
}

void read_log(std::ifstream& log, const Arguments& arguments, Output& output) {
  Reader reader(arguments, output);
  std::string interface = arguments.interface;
  std::array<char, 512> line;  // a frame is shorter; what is longer is cut, and no frame
  while (!reader.has_enough() && (log.getline(line.data(), line.size()) || log.gcount() != 0)) {
    if (log.fail() && !log.eof()) log.clear();
    const auto logged = platform::parse_candump_line(line.data());
    if (!logged) {
      ++output.counts.lines_skipped;
      continue;
    }
    ++output.counts.frames;
    if (!reader.is_ours(logged->frame)) continue;
    if (interface.empty()) interface = logged->interface;
    if (logged->interface != interface) {
      ++output.counts.frames_elsewhere;
      continue;
    }
    reader.take(logged->frame, logged->stamp_utc_ns);
  }
  reader.finish();
}

volatile std::sig_atomic_t stop_asked = 0;

/// Ctrl-C and SIGTERM ask to stop, while it lives.
class StopOnSignal {
 public:
  StopOnSignal() {
    stop_asked = 0;
    struct sigaction action {};
    action.sa_handler = [](int) { stop_asked = 1; };
    ::sigaction(SIGINT, &action, &old_interrupt_);
    ::sigaction(SIGTERM, &action, &old_terminate_);
  }
  ~StopOnSignal() {
    ::sigaction(SIGINT, &old_interrupt_, nullptr);
    ::sigaction(SIGTERM, &old_terminate_, nullptr);
  }
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

 private:
  struct sigaction old_interrupt_ {};
  struct sigaction old_terminate_ {};
};

[[nodiscard]] std::vector<platform::CanId> ids_of_poses(std::uint32_t base_id) {
  std::vector<platform::CanId> ids;
  ids.reserve(platform::kFrameLayouts.size());
  for (const platform::FrameLayout& layout : platform::kFrameLayouts)
    ids.push_back({base_id + layout.id_offset});
  return ids;
}

void read_interface(const Arguments& arguments, Output& output) {
  constexpr int kWait_ms = 100;
  platform::CanReceiver receiver(arguments.source, ids_of_poses(arguments.base_id));
  platform::BusState said = platform::BusState::up;
  if (receiver.state() == platform::BusState::missing) {
    throw std::runtime_error(
        fmt::format("no such log, and no interface: {}",
                    platform::describe_bus(arguments.source, receiver.state(), receiver.error())));
  }
  const StopOnSignal stop;
  const std::int64_t end_ns =
      arguments.seconds == 0.0
          ? std::numeric_limits<std::int64_t>::max()
          : platform::monotonic_ns() + static_cast<std::int64_t>(arguments.seconds * 1e9);
  Reader reader(arguments, output);
  while (stop_asked == 0 && !reader.has_enough() && platform::monotonic_ns() < end_ns) {
    pollfd waiting{.fd = receiver.descriptor(), .events = POLLIN, .revents = 0};
    ::poll(&waiting, 1, kWait_ms);
    platform::CanFrame frame;
    std::int64_t stamp_utc_ns = 0;
    while (!reader.has_enough() && receiver.receive(frame, stamp_utc_ns)) {
      ++output.counts.frames;
      reader.take(frame, stamp_utc_ns);
    }
    std::fflush(stdout);
    receiver.maintain(platform::monotonic_ns());
    if (receiver.state() == said) continue;
    said = receiver.state();
    fmt::print(stderr, "landfix: {}\n", platform::describe_bus(arguments.source, said, receiver.error()));
  }
  reader.finish();
  if (receiver.frames_overflowed() != 0)
    fmt::print(stderr, "landfix: {} frames came faster than they were read\n", receiver.frames_overflowed());
}

/// A log may have any name, an interface is none of the files.
[[nodiscard]] bool is_interface(const std::string& source) {
  std::error_code ignored;
  return platform::is_can_interface_name(source) && !std::filesystem::exists(source, ignored);
}

}  // namespace

void decode_can(const CanDecodeArguments& arguments) {
  Output output(arguments.json);
  if (is_interface(arguments.source)) {
    read_interface(arguments, output);
  } else {
    std::ifstream log = open_log(arguments.source);
    read_log(log, arguments, output);
  }
  const Counts& counts = output.counts;
  if (counts.frames_ours == 0) {
    throw std::runtime_error(fmt::format(
        "{}: no pose at base id 0x{:X}{} among {} frames, {} lines are none; choose with --base-id, "
        "--interface",
        arguments.source, arguments.base_id, arguments.interface.empty() ? "" : " on " + arguments.interface,
        counts.frames, counts.lines_skipped));
  }
  if (counts.frames_elsewhere != 0) {
    fmt::print(stderr, "landfix: {} pose frames on other interfaces were left out; choose with --interface\n",
               counts.frames_elsewhere);
  }
  output.finish();
}

}  // namespace landfix::tools
