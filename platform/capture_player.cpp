#include "platform/capture_player.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>
#include <sys/prctl.h>

#include "platform/ipv4.hpp"
#include "platform/monotonic_clock.hpp"

namespace landfix::platform {
namespace {

constexpr std::size_t kMaxPayload_bytes = 65'507;
constexpr std::size_t kSlots = 32;

[[nodiscard]] bool is_loopback(std::uint32_t address) noexcept { return address >> 24U == 127; }

template <class Value>
void set_option(const FileDescriptor& socket, int level, int option, const Value& value) {
  if (::setsockopt(socket.number(), level, option, &value, sizeof value) != 0)
    throw std::runtime_error(fmt::format("cannot set up a socket to send from: {}", std::strerror(errno)));
}

[[nodiscard]] sockaddr_in socket_address(std::uint32_t address, std::uint16_t port) noexcept {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(port);
  result.sin_addr.s_addr = htonl(address);
  return result;
}

/// What the capture's packets came from, or 0 where it could not reach the destination.
[[nodiscard]] std::uint32_t sensor_address(const PlaySettings& settings) {
  PcapSource source(settings.file);
  UdpPacket first;
  if (source.next(first) != ReadStatus::packet) return 0;
  const bool stays_here = is_loopback(first.source_address) && !is_loopback(settings.to_address);
  return stays_here ? 0 : first.source_address;
}

[[nodiscard]] FileDescriptor open_socket(const PlaySettings& settings) {
  FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!socket.is_open())
    throw std::runtime_error(fmt::format("cannot open a socket to send from: {}", std::strerror(errno)));
  set_option(socket, SOL_SOCKET, SO_BROADCAST, 1);
  set_option(socket, IPPROTO_IP, IP_MULTICAST_TTL, settings.multicast_hops);
  const bool is_asked_for = settings.from_address != 0;
  const std::uint32_t address = is_asked_for ? settings.from_address : sensor_address(settings);
  const sockaddr_in from = socket_address(address, 0);
  if (::bind(socket.number(), reinterpret_cast<const sockaddr*>(&from), sizeof from) != 0) {
    if (!is_asked_for) return socket;
    throw std::runtime_error(fmt::format(
        "cannot send from {0}: {1}; ip addr add {0}/24 dev INTERFACE gives this computer the address",
        to_ipv4_text(settings.from_address), std::strerror(errno)));
  }
  set_option(socket, IPPROTO_IP, IP_MULTICAST_IF, from.sin_addr);
  return socket;
}

}  // namespace

CapturePlayer::CapturePlayer(const PlaySettings& settings)
    : ports_(settings.ports),
      to_address_(settings.to_address),
      socket_(open_socket(settings)),
      receiver_({.file = settings.file, .speed = settings.speed, .laps = settings.laps}),
      ring_(kMaxPayload_bytes, kSlots),
      began_mono_ns_(monotonic_ns()) {
  // Sleeps as exact as the system can; by default they end up to 50 us late.
  ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

bool CapturePlayer::play_some() {
  constexpr std::int64_t kPatience_ns = 200'000'000;
  const ReceiveStatus status = receiver_.receive(ring_, monotonic_ns() + kPatience_ns);
  if (status == ReceiveStatus::packets) send_all(ring_.waiting(kSlots));
  counters_.lasted_ns = monotonic_ns() - began_mono_ns_;
  return status == ReceiveStatus::packets || status == ReceiveStatus::nothing;
}

void CapturePlayer::send_all(std::size_t count) {
  std::array<mmsghdr, kSlots> messages{};
  std::array<iovec, kSlots> parts{};
  std::array<sockaddr_in, kSlots> destinations{};
  for (std::size_t i = 0; i < count; ++i) {
    const UdpPacket packet = ring_.front(i);
    const auto renamed = ports_.find(packet.destination_port);
    destinations[i] =
        socket_address(to_address_, renamed == ports_.end() ? packet.destination_port : renamed->second);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): iovec serves reading and writing
    parts[i] = {.iov_base = const_cast<std::byte*>(packet.payload.data()), .iov_len = packet.payload.size()};
    messages[i].msg_hdr.msg_name = &destinations[i];
    messages[i].msg_hdr.msg_namelen = sizeof destinations[i];
    messages[i].msg_hdr.msg_iov = &parts[i];
    messages[i].msg_hdr.msg_iovlen = 1;
  }
  for (std::size_t i = 0; i < count;) {
    const int sent = ::sendmmsg(socket_.number(), &messages[i], static_cast<unsigned>(count - i), 0);
    if (sent > 0) {
      for (const std::size_t end = i + static_cast<std::size_t>(sent); i < end; ++i) {
        ++counters_.packets;
        counters_.bytes += parts[i].iov_len;
      }
    } else if (errno == ENOBUFS) {
      ++counters_.not_sent;
      ++i;
    } else if (errno != EINTR) {
      throw std::runtime_error(fmt::format("cannot send to {}: {}; see ip route get {}",
                                           to_ipv4_text(to_address_), std::strerror(errno),
                                           to_ipv4_text(to_address_)));
    }
  }
  const std::int64_t now_ns = monotonic_ns();
  for (std::size_t i = 0; i < count; ++i) {
    counters_.late_at_most_ns = std::max(counters_.late_at_most_ns, now_ns - ring_.header(i).arrived_mono_ns);
  }
  ring_.free(count);
}

std::uint16_t busiest_port(const std::filesystem::path& file) {
  PcapSource source(file);
  std::map<std::uint16_t, std::uint64_t> bytes;
  for (UdpPacket packet; source.next(packet) == ReadStatus::packet;) {
    bytes[packet.destination_port] += packet.payload.size();
  }
  const auto busiest = std::max_element(bytes.begin(), bytes.end(),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
  if (busiest == bytes.end()) throw std::runtime_error(fmt::format("{}: no UDP packet in it", file.string()));
  return busiest->first;
}

}  // namespace landfix::platform
