#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>

#include "platform/ipv4.hpp"
#include "platform/monotonic_clock.hpp"
#include "platform/multicast.hpp"
#include "platform/source_filter.hpp"
#include "platform/udp_receiver.hpp"

namespace landfix::platform {
namespace {

constexpr std::size_t kSmallBuffer_bytes = std::size_t{256} << 10U;  // of strangers, and of what comes seldom

[[noreturn]] void fail(std::uint16_t port, std::string_view doing, std::string_view what_to_do) {
  throw std::runtime_error(
      fmt::format("UDP port {}: cannot {}: {}; {}", port, doing, std::strerror(errno), what_to_do));
}

void set_option(const FileDescriptor& socket, std::uint16_t port, int level, int option,
                std::string_view name) {
  const int on = 1;
  if (::setsockopt(socket.number(), level, option, &on, sizeof on) != 0)
    fail(port, fmt::format("set {}", name), "Linux 5.10 or newer has it");
}

[[nodiscard]] FileDescriptor open_socket(std::uint16_t port) {
  FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket.is_open()) fail(port, "open a socket", "raise the limit of open files");
  return socket;
}

/// Returns the port, which the kernel chooses if it is 0.
std::uint16_t bind_socket(const FileDescriptor& socket, std::uint16_t port, const UdpSettings& settings) {
  // The address of an interface may come and go, and be given only after this program has started.
  set_option(socket, port, IPPROTO_IP, IP_FREEBIND, "IP_FREEBIND");
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  const bool is_multicast = settings.multicast_group != 0;
  address.sin_addr.s_addr = htonl(is_multicast ? settings.multicast_group : settings.interface_address);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (::bind(socket.number(), generic, size) != 0) {
    fail(port, "listen to it",
         errno == EADDRINUSE ? fmt::format("stop the program that does (ss -ulnp 'sport = {}')", port)
                             : "choose another with [sensor] port");
  }
  ::getsockname(socket.number(), generic, &size);
  return ntohs(address.sin_port);
}

/// A warning where the kernel gives less than is asked for, else nothing.
[[nodiscard]] std::string set_buffer(const FileDescriptor& socket, std::uint16_t port,
                                     std::size_t wanted_bytes) {
  // The kernel doubles what it is told, and counts packets with all that it keeps beside them.
  const int half = static_cast<int>(wanted_bytes / 2);
  if (::setsockopt(socket.number(), SOL_SOCKET, SO_RCVBUFFORCE, &half, sizeof half) != 0)
    ::setsockopt(socket.number(), SOL_SOCKET, SO_RCVBUF, &half, sizeof half);
  int has = 0;
  socklen_t size = sizeof has;
  ::getsockopt(socket.number(), SOL_SOCKET, SO_RCVBUF, &has, &size);
  if (static_cast<std::size_t>(has) / 2 >= static_cast<std::size_t>(half)) return {};
  return fmt::format(
      "UDP port {}: its receive buffer has {:.1f} MiB instead of {:.1f}, so packets may be lost while the "
      "computer is busy; sysctl net.core.rmem_max={}, or CAP_NET_ADMIN, gives all of it",
      port, has / 1048576.0, static_cast<double>(wanted_bytes) / 1048576.0, half);
}

/// Sockets that share a port let a second program share it too, unnoticed: so it must be free before.
[[nodiscard]] std::uint16_t find_free_port(std::uint16_t port, const UdpSettings& settings) {
  return bind_socket(open_socket(port), port, settings);
}

/// All but bound, so that it receives nothing before it says everything of a packet.
[[nodiscard]] std::tuple<FileDescriptor, std::string> prepare_socket(std::uint16_t port,
                                                                     std::size_t buffer_bytes) {
  FileDescriptor socket = open_socket(port);
  set_option(socket, port, SOL_SOCKET, SO_RXQ_OVFL, "SO_RXQ_OVFL");
  set_option(socket, port, SOL_SOCKET, SO_TIMESTAMPNS, "SO_TIMESTAMPNS");
  std::string warning = set_buffer(socket, port, buffer_bytes);
  return {std::move(socket), std::move(warning)};
}

/// For strangers, for the sensor, and a warning.
[[nodiscard]] std::tuple<FileDescriptor, FileDescriptor, std::string> open_divided(
    std::uint16_t port, const UdpSettings& settings, std::size_t buffer_bytes) {
  FileDescriptor strangers = std::get<FileDescriptor>(prepare_socket(port, kSmallBuffer_bytes));
  auto [sensor, warning] = prepare_socket(port, buffer_bytes);
  for (const FileDescriptor* const socket : {&strangers, &sensor}) {
    set_option(*socket, port, SOL_SOCKET, SO_REUSEPORT, "SO_REUSEPORT");
    set_option(*socket, port, IPPROTO_IP, IP_PKTINFO, "IP_PKTINFO");
  }
  keep_all_but(strangers.number(), settings.sensor_address);
  keep_only(sensor.number(), settings.sensor_address);
  bind_socket(strangers, port, settings);
  divide_by_source(strangers.number(), settings.sensor_address);
  bind_socket(sensor, port, settings);
  return {std::move(strangers), std::move(sensor), std::move(warning)};
}

void join(const FileDescriptor& socket, std::uint16_t port, const UdpSettings& settings,
          std::vector<std::string>& warnings) {
  if (join_group(socket.number(), settings.multicast_group, settings.interface_address)) return;
  if (errno != ENODEV) {
    fail(port, fmt::format("join the multicast group {}", to_ipv4_text(settings.multicast_group)),
         "check [sensor] multicast and interface");
  }
  warnings.push_back(
      fmt::format("UDP port {}: no interface for the multicast group {} yet; it is tried every second, see "
                  "[sensor] interface",
                  port, to_ipv4_text(settings.multicast_group)));
}

}  // namespace

UdpReceiver::UdpReceiver(const UdpSettings& settings)
    : multicast_group_(settings.multicast_group),
      interface_address_(settings.interface_address),
      heard_or_joined_mono_ns_(monotonic_ns()) {
  for (std::size_t i = 0; i < settings.ports.size(); ++i) {
    Port port;
    port.number = find_free_port(settings.ports[i], settings);
    const std::size_t buffer_bytes = i == 0 ? settings.receive_buffer_bytes : kSmallBuffer_bytes;
    std::string warning;
    if (settings.sensor_address != 0) {
      std::tie(port.strangers.socket, port.sensor.socket, warning) =
          open_divided(port.number, settings, buffer_bytes);
    } else {
      std::tie(port.sensor.socket, warning) = prepare_socket(port.number, buffer_bytes);
      bind_socket(port.sensor.socket, port.number, settings);
    }
    if (!warning.empty()) warnings_.push_back(std::move(warning));
    if (settings.multicast_group != 0) join(port.sensor.socket, port.number, settings, warnings_);
    watched_.push_back({.fd = port.sensor.socket.number(), .events = POLLIN, .revents = 0});
    ports_.push_back(std::move(port));
  }
}

UdpReceiver::~UdpReceiver() = default;

}  // namespace landfix::platform
