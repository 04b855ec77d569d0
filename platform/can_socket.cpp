#include "platform/can_socket.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace landfix::platform {
namespace {

template <class Value>
[[nodiscard]] bool set(int socket, int level, int option, const Value& value) noexcept {
  return ::setsockopt(socket, level, option, &value, sizeof value) == 0;
}

[[nodiscard]] ifreq request_for(const CanInterfaceName& interface) noexcept {
  ifreq request{};
  static_assert(sizeof request.ifr_name == CanInterfaceName::kMaxLength + 1);
  std::memcpy(request.ifr_name, interface.c_str(), sizeof request.ifr_name);
  return request;
}

/// Data frames alone: a remote frame carries nothing.
[[nodiscard]] can_filter filter_for(CanId id) noexcept {
  if (id.extended) return {id.id | CAN_EFF_FLAG, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_EFF_MASK};
  return {id.id, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_SFF_MASK};
}

/// A socket without a filter receives nothing, and the kernel queues nothing for it.
[[nodiscard]] bool receive_no_frames(int socket) noexcept {
  return ::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0) == 0;
}

[[nodiscard]] bool receive_only(int socket, std::span<const CanId> ids) noexcept {
  constexpr std::size_t kMaxFilters = 64;
  if (ids.empty()) return true;
  if (ids.size() > kMaxFilters) {
    errno = EINVAL;
    return false;
  }
  std::array<can_filter, kMaxFilters> filters;
  std::transform(ids.begin(), ids.end(), filters.begin(), filter_for);
  return ::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                      static_cast<socklen_t>(ids.size() * sizeof(can_filter))) == 0;
}

[[nodiscard]] bool configure(int socket, const CanSocketRequest& request) noexcept {
  constexpr int kOn = 1;
  constexpr can_err_mask_t kErrors = CAN_ERR_CRTL | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;
  if (request.fd && !set(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, kOn)) return false;
  switch (request.use) {
    case CanSocketUse::transmit:
      return receive_no_frames(socket);
    case CanSocketUse::errors:
      return receive_no_frames(socket) && set(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, kErrors);
    case CanSocketUse::receive:
      return receive_only(socket, request.ids) && set(socket, SOL_SOCKET, SO_TIMESTAMPNS, kOn) &&
             set(socket, SOL_SOCKET, SO_RXQ_OVFL, kOn);
  }
  return false;
}

[[nodiscard]] bool bind_to(int socket, const CanInterfaceName& interface) noexcept {
  ifreq index = request_for(interface);
  if (::ioctl(socket, SIOCGIFINDEX, &index) != 0) return false;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index.ifr_ifindex;
  return ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

/// Frames of CAN FD need an interface that is set to it.
[[nodiscard]] bool takes_fd(int socket, const CanInterfaceName& interface) noexcept {
  ifreq mtu = request_for(interface);
  if (::ioctl(socket, SIOCGIFMTU, &mtu) != 0) return false;
  if (mtu.ifr_mtu >= static_cast<int>(CANFD_MTU)) return true;
  errno = EMSGSIZE;
  return false;
}

int open_socket(const CanSocketRequest& request) noexcept {
  FileDescriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (!socket.is_open() || !configure(socket.number(), request) ||
      !bind_to(socket.number(), request.interface)) {
    return -errno;
  }
  if (request.use == CanSocketUse::transmit && request.fd && !takes_fd(socket.number(), request.interface)) {
    return -errno;
  }
  return socket.release();
}

CanLink link_of(int socket, const CanInterfaceName& interface) noexcept {
  // An error that waits is taken, as it would be told to the next call, when it may be over.
  int waiting = 0;
  socklen_t size = sizeof waiting;
  if (::getsockopt(socket, SOL_SOCKET, SO_ERROR, &waiting, &size) != 0) return {.error = errno};
  if (waiting != 0 && waiting != ENETDOWN) return {.error = waiting};
  ifreq flags = request_for(interface);
  if (::ioctl(socket, SIOCGIFFLAGS, &flags) != 0) return {.error = errno};
  const auto has = [&](int flag) { return (flags.ifr_flags & flag) != 0; };
  return {.is_up = has(IFF_UP), .is_running = has(IFF_RUNNING)};
}

constexpr CanSystem kLinuxCan{.open = open_socket, .link = link_of};

}  // namespace

CanInterfaceName::CanInterfaceName(std::string_view name) noexcept {
  std::copy_n(name.begin(), std::min(name.size(), kMaxLength), text_.begin());
}

const CanSystem& linux_can() noexcept { return kLinuxCan; }

}  // namespace landfix::platform
