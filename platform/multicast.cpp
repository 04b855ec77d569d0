#include "platform/multicast.hpp"

#include <cerrno>

#include <netinet/in.h>
#include <sys/socket.h>

namespace landfix::platform {

bool join_group(int descriptor, std::uint32_t group, std::uint32_t interface_address) noexcept {
  const ip_mreq request{.imr_multiaddr = {.s_addr = htonl(group)},
                        .imr_interface = {.s_addr = htonl(interface_address)}};
  const auto ask = [&](int option) {
    return ::setsockopt(descriptor, IPPROTO_IP, option, &request, sizeof request) == 0;
  };
  if (ask(IP_ADD_MEMBERSHIP) || errno == EADDRINUSE) return true;
  if (errno != ENOBUFS) return false;
  // Memberships of interfaces that are gone count until they are given up.
  while (ask(IP_DROP_MEMBERSHIP)) {
  }
  return ask(IP_ADD_MEMBERSHIP);
}

}  // namespace landfix::platform
