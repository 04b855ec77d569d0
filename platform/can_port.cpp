#include "platform/can_port.hpp"

#include <array>
#include <cerrno>

namespace landfix::platform {

std::string_view to_string(BusState state) noexcept {
  constexpr std::array<std::string_view, kBusStates> kNames{"up", "error_passive", "bus_off", "down",
                                                            "missing"};
  return kNames[static_cast<std::size_t>(state)];
}

CanPort::CanPort(const CanSocketRequest& request, const CanSystem& system) noexcept
    : request_(request), system_(system) {
  open();
}

bool CanPort::maintain(std::int64_t monotonic_ns) noexcept {
  if (monotonic_ns < due_ns_) return false;
  if (socket_.is_open()) follow(system_.link(socket_.number(), request_.interface), monotonic_ns);
  const bool is_new = !socket_.is_open() && open();
  due_ns_ = monotonic_ns + (error() == EAFNOSUPPORT ? kPeriodWithoutCan_ns : kPeriod_ns);
  return is_new;
}

bool CanPort::open() noexcept {
  const int result = system_.open(request_);
  if (result < 0) {
    become(BusState::missing, -result);
    return false;
  }
  socket_ = FileDescriptor(result);
  become(BusState::up, 0);
  follow(system_.link(result, request_.interface), bus_off_ns_);
  return socket_.is_open();
}

void CanPort::follow(const CanLink& link, std::int64_t monotonic_ns) noexcept {
  if (link.error != 0) {
    failed(link.error);
  } else if (!link.is_up) {
    become(BusState::down, ENETDOWN);
  } else if (!link.is_running) {
    become(BusState::bus_off, 0);
  } else if (state() == BusState::down ||
             (state() == BusState::bus_off && monotonic_ns - bus_off_ns_ >= kLinkLag_ns)) {
    become(BusState::up, 0);
  }
}

void CanPort::failed(int error) noexcept {
  if (error == ENETDOWN) {
    become(BusState::down, error);
    return;
  }
  // ENODEV, ENXIO: the interface is gone. Whatever else it may be, a new socket is the mend.
  if (socket_.is_open()) ++times_lost_;
  socket_.close();
  become(BusState::missing, error);
}

void CanPort::worked() noexcept {
  if (state() == BusState::down) become(BusState::up, 0);
}

void CanPort::set_error_passive(bool is_passive) noexcept {
  if (state() == BusState::up && is_passive) become(BusState::error_passive, 0);
  if (state() == BusState::error_passive && !is_passive) become(BusState::up, 0);
}

void CanPort::set_bus_off(std::int64_t monotonic_ns) noexcept {
  bus_off_ns_ = monotonic_ns;
  become(BusState::bus_off, 0);
}

void CanPort::set_restarted() noexcept {
  if (state() == BusState::bus_off || state() == BusState::error_passive) become(BusState::up, 0);
}

void CanPort::become(BusState state, int error) noexcept {
  state_.store(state, std::memory_order_relaxed);
  error_.store(error, std::memory_order_relaxed);
}

}  // namespace landfix::platform
