// An interface of CAN that a test holds the other end of: pairs of sockets that keep the bounds of frames,
// with the same bytes in them, and a queue that gets full.
#pragma once

#include <cerrno>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>

#include "platform/can_socket.hpp"
#include "platform/can_wire.hpp"

namespace landfix::test {

/// One at a time: what the kernel is asked for has no other way to it.
class FakeCan {
 public:
  FakeCan() { current_ = this; }
  ~FakeCan() { current_ = nullptr; }
  FakeCan(const FakeCan&) = delete;
  FakeCan& operator=(const FakeCan&) = delete;

  int open_error = 0;  ///< errno with which opening fails
  platform::CanLink link{.is_up = true, .is_running = true};
  int times_opened = 0;  ///< of frames' sockets, tried
  std::vector<platform::CanId> ids;

  [[nodiscard]] static const platform::CanSystem& system() noexcept {
    static constexpr platform::CanSystem kSystem{
        .open = [](const platform::CanSocketRequest& request) noexcept { return current_->open(request); },
        .link = [](int, const platform::CanInterfaceName&) noexcept { return current_->link; }};
    return kSystem;
  }

  /// The interface is deleted: what is open fails.
  void remove() {
    bus_.close();
    errors_.close();
    open_error = ENODEV;
  }
  /// What has been sent and not been taken yet.
  [[nodiscard]] std::optional<platform::CanFrame> take() const {
    canfd_frame frame;
    const ssize_t size = ::recv(bus_.number(), &frame, sizeof frame, MSG_DONTWAIT);
    if (size <= 0) return std::nullopt;
    return platform::from_wire(std::as_bytes(std::span(&frame, 1)).first(static_cast<std::size_t>(size)));
  }
  void give(std::span<const std::byte> bytes) const {
    ASSERT_EQ(::send(bus_.number(), bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  }
  void give(const platform::CanFrame& frame) const { give(platform::to_wire(frame).bytes()); }
  /// As a controller tells of the bus; `kinds`: CAN_ERR_..., `controller`: CAN_ERR_CRTL_...
  void report_error(canid_t kinds, unsigned controller = 0) const {
    can_frame frame{};
    frame.can_id = CAN_ERR_FLAG | kinds;
    frame.can_dlc = 8;
    frame.data[1] = static_cast<__u8>(controller);
    ASSERT_EQ(::send(errors_.number(), &frame, sizeof frame, 0), static_cast<ssize_t>(sizeof frame));
  }

 private:
  int open(const platform::CanSocketRequest& request) noexcept {
    const bool is_for_errors = request.use == platform::CanSocketUse::errors;
    if (!is_for_errors) ++times_opened;
    if (open_error != 0) return -open_error;
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) != 0) return -errno;
    (is_for_errors ? errors_ : bus_) = platform::FileDescriptor(ends[1]);
    if (request.use == platform::CanSocketUse::receive) ids.assign(request.ids.begin(), request.ids.end());
    return ends[0];
  }

  static inline FakeCan* current_ = nullptr;
  platform::FileDescriptor bus_;
  platform::FileDescriptor errors_;
};

}  // namespace landfix::test
