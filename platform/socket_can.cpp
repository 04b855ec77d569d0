#include "platform/socket_can.hpp"

#include <cerrno>

#include <linux/can/error.h>
#include <sys/socket.h>

#include "platform/can_wire.hpp"

namespace landfix::platform {
namespace {

/// errno, or 0.
[[nodiscard]] int send_one(int socket, const CanFrame& frame) noexcept {
  const WireFrame wire = to_wire(frame);
  const ssize_t sent = ::send(socket, &wire.frame, wire.size, MSG_DONTWAIT | MSG_NOSIGNAL);
  return sent < 0 ? errno : 0;
}

/// The queue of the interface or that of the socket.
[[nodiscard]] bool is_queue_full(int error) noexcept {
  return error == ENOBUFS || error == EAGAIN || error == EWOULDBLOCK;
}

}  // namespace

SocketCan::SocketCan(std::string_view interface, bool fd, const CanSystem& system) noexcept
    : error_request_{.interface = CanInterfaceName(interface), .use = CanSocketUse::errors},
      system_(system),
      port_({.interface = CanInterfaceName(interface), .use = CanSocketUse::transmit, .fd = fd}, system),
      errors_(port_.socket() < 0 ? -1 : system.open(error_request_)) {}

std::size_t SocketCan::send(std::span<const CanFrame> group, std::int64_t /*stamp_utc_ns*/) noexcept {
  std::size_t taken = 0;
  int error = port_.socket() < 0 || port_.state() == BusState::bus_off ? ENETDOWN : 0;
  while (error == 0 && taken < group.size()) {
    error = send_one(port_.socket(), group[taken]);
    if (error == 0) ++taken;
  }
  if (taken != 0) port_.worked();
  frames_sent_ += taken;
  count_dropped(group.size() - taken, error);
  return taken;
}

void SocketCan::count_dropped(std::size_t frames, int error) noexcept {
  if (frames == 0) return;
  if (is_queue_full(error)) {
    dropped_queue_full_ += frames;
    return;
  }
  dropped_bus_down_ += frames;
  if (port_.socket() >= 0 && port_.state() != BusState::bus_off) port_.failed(error);
}

void SocketCan::maintain(std::int64_t monotonic_ns) noexcept {
  read_errors(monotonic_ns);
  if (port_.maintain(monotonic_ns)) errors_ = FileDescriptor(system_.open(error_request_));
}

void SocketCan::read_errors(std::int64_t monotonic_ns) noexcept {
  constexpr int kMostFrames = 32;  // a controller tells of changes, not of each error
  for (int i = 0; i < kMostFrames && errors_.is_open(); ++i) {
    can_frame frame{};
    const ssize_t size = ::recv(errors_.number(), &frame, sizeof frame, MSG_DONTWAIT);
    if (size == static_cast<ssize_t>(sizeof frame)) {
      take_error_frame(frame, monotonic_ns);
    } else if (size < 0 && errno != ENETDOWN) {
      if (errno == ENODEV) port_.failed(errno);
      return;
    } else if (size < 0) {
      port_.failed(errno);
    }
  }
}

void SocketCan::take_error_frame(const can_frame& frame, std::int64_t monotonic_ns) noexcept {
  constexpr unsigned kPassive = CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE;
  constexpr unsigned kBetter = CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING | CAN_ERR_CRTL_ACTIVE;
  if ((frame.can_id & CAN_ERR_FLAG) == 0) return;
  if ((frame.can_id & CAN_ERR_BUSOFF) != 0) port_.set_bus_off(monotonic_ns);
  if ((frame.can_id & CAN_ERR_RESTARTED) != 0) port_.set_restarted();
  if ((frame.can_id & CAN_ERR_CRTL) == 0) return;
  if ((frame.data[1] & kPassive) != 0)
    port_.set_error_passive(true);
  else if ((frame.data[1] & kBetter) != 0)
    port_.set_error_passive(false);
}

BusStatus SocketCan::status() const noexcept {
  return {.state = port_.state(),
          .error = port_.error(),
          .frames_sent = frames_sent_,
          .dropped_queue_full = dropped_queue_full_,
          .dropped_bus_down = dropped_bus_down_,
          .times_lost = port_.times_lost()};
}

}  // namespace landfix::platform
