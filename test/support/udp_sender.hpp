// A UDP socket that sends on this computer's own network.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/frames.hpp"

namespace landfix::test {

constexpr std::uint32_t loopback(unsigned last) { return 0x7F000000 + last; }  // 127.0.0.x

class UdpSender {
 public:
  /// From this address and any port.
  explicit UdpSender(std::uint32_t from) : descriptor_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const int on = 1;
    ::setsockopt(descriptor_, SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
    const in_addr outgoing{htonl(from)};
    ::setsockopt(descriptor_, IPPROTO_IP, IP_MULTICAST_IF, &outgoing, sizeof outgoing);
    const sockaddr_in address = to(from, 0);
    if (::bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("cannot bind to a loopback address");
  }
  ~UdpSender() { ::close(descriptor_); }
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// False where the system does not send it.
  bool send(std::uint32_t address, std::uint16_t port, const Bytes& payload) {
    const sockaddr_in destination = to(address, port);
    return ::sendto(descriptor_, payload.data(), payload.size(), 0,
                    reinterpret_cast<const sockaddr*>(&destination),
                    sizeof destination) == static_cast<ssize_t>(payload.size());
  }

 private:
  static sockaddr_in to(std::uint32_t address, std::uint16_t port) {
    sockaddr_in result{};
    result.sin_family = AF_INET;
    result.sin_port = htons(port);
    result.sin_addr.s_addr = htonl(address);
    return result;
  }

  int descriptor_;
};

}  // namespace landfix::test
