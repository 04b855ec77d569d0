// landfix play: a capture back onto the network.
#include <charconv>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <netdb.h>
#include <nlohmann/json.hpp>

#include "platform/capture_player.hpp"
#include "platform/ipv4.hpp"
#include "platform/monotonic_clock.hpp"
#include "tools/command.hpp"
#include "tools/landfix_commands.hpp"

namespace landfix::tools {
namespace {

struct PlayArguments {
  std::string to;
  std::string from;
  platform::PlaySettings settings;
  bool json = false;
};

struct Destination {
  std::string host;
  std::optional<std::uint16_t> port;
};

Destination parse_destination(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {.host = text, .port = {}};
  const char* const end = text.data() + text.size();
  std::uint16_t port = 0;
  const auto [stopped, error] = std::from_chars(text.data() + colon + 1, end, port);
  if (error != std::errc() || stopped != end || port == 0) {
    throw UsageError(fmt::format("--to {}: expected HOST or HOST:PORT, with a port from 1 to 65535", text));
  }
  return {.host = text.substr(0, colon), .port = port};
}

std::uint32_t resolve(const std::string& option, const std::string& host) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), nullptr, &wanted, &found);
  if (error != 0) {
    throw UsageError(fmt::format("{} {}: {}; expected an IPv4 address or a host that has one", option, host,
                                 ::gai_strerror(error)));
  }
  sockaddr_in address{};
  std::memcpy(&address, found->ai_addr, sizeof address);
  ::freeaddrinfo(found);
  return ntohl(address.sin_addr.s_addr);
}

/// Until the end, with a line of progress a few times a second.
void play_all(platform::CapturePlayer& player, std::uint64_t laps) {
  constexpr std::int64_t kBetweenLines_ns = 200'000'000;
  std::int64_t next_line_mono_ns = 0;
  while (player.play_some()) {
    if (platform::monotonic_ns() < next_line_mono_ns) continue;
    next_line_mono_ns = platform::monotonic_ns() + kBetweenLines_ns;
    show_progress(fmt::format("{:3.0f} %{}, {} packets", player.percent_of_lap(),
                              laps == 1 ? "" : " of the lap", player.counters().packets));
  }
  show_progress("");
}

void play(const PlayArguments& arguments) {
  platform::PlaySettings settings = arguments.settings;
  const Destination destination = parse_destination(arguments.to);
  settings.to_address = resolve("--to", destination.host);
  if (!arguments.from.empty()) settings.from_address = resolve("--from", arguments.from);
  if (destination.port) settings.ports[platform::busiest_port(settings.file)] = *destination.port;

  platform::CapturePlayer player(settings);
  play_all(player, settings.laps);
  const platform::PlayCounters& counters = player.counters();
  if (*player.read_error() != '\0') {
    fmt::print(stderr, "landfix: {}: it is cut off ({}); what comes before was sent\n",
               settings.file.string(), player.read_error());
  }
  if (counters.packets + counters.not_sent == 0)
    throw std::runtime_error(fmt::format("{}: no UDP packet in it", settings.file.string()));

  const double seconds = static_cast<double>(counters.lasted_ns) * 1e-9;
  const double late_ms = static_cast<double>(counters.late_at_most_ns) * 1e-6;
  if (arguments.json) {
    const nlohmann::ordered_json object{{"to", platform::to_ipv4_text(settings.to_address)},
                                        {"packets", counters.packets},
                                        {"bytes", counters.bytes},
                                        {"not_sent", counters.not_sent},
                                        {"seconds", seconds},
                                        {"late_ms", {{"max", late_ms}}}};
    fmt::print("{}\n", object.dump(2));
  } else {
    fmt::print("{} packets, {} bytes to {} in {:.1f} s; late by {:.3f} ms at most{}\n", counters.packets,
               counters.bytes, platform::to_ipv4_text(settings.to_address), seconds, late_ms,
               counters.not_sent == 0
                   ? ""
                   : fmt::format("; {} not sent, the interface's queue was full", counters.not_sent));
  }
}

}  // namespace

void add_play_command(CLI::App& app) {
  const auto arguments = std::make_shared<PlayArguments>();
  platform::PlaySettings& settings = arguments->settings;
  CLI::App& command = *app.add_subcommand("play", "a capture back onto the network, at its recorded times");
  command.add_option("--pcap", settings.file, "capture, pcap or pcapng")->required()->type_name("FILE");
  command
      .add_option(
          "--to", arguments->to,
          "a computer, a broadcast or a multicast group; ports are kept, but PORT is given in place of "
          "the data's")
      ->required()
      ->type_name("HOST[:PORT]");
  command
      .add_option("--from", arguments->from,
                  "address of this computer to send from; else the recorded one, if it has it")
      ->type_name("ADDRESS");
  command.add_option("--speed", settings.speed, "times the recorded pace; 0: as fast as it goes")
      ->check(in_range(0.0, 1e6))
      ->type_name("X")
      ->capture_default_str();
  command.add_option("--loop", settings.laps, "how often the capture is played")
      ->check(in_range(std::uint64_t{1}, std::uint64_t{1'000'000'000}))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--ttl", settings.multicast_hops, "networks that a multicast may cross")
      ->check(in_range(0, 255))
      ->type_name("N")
      ->capture_default_str();
  add_json_option(command, arguments->json);
  command.callback([arguments] { play(*arguments); });
}

}  // namespace landfix::tools
