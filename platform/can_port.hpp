// A socket on a CAN interface that may go down, go, and come back, perhaps with another index: it is opened
// again without anyone's help. One thread uses it; the state may be read by any.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>

#include "platform/bus_status.hpp"
#include "platform/can_socket.hpp"
#include "platform/relaxed_counter.hpp"

namespace landfix::platform {

class CanPort {
 public:
  /// How often the interface is looked at, and tried to be opened.
  static constexpr std::int64_t kPeriod_ns = 100'000'000;
  /// Where the kernel has no CAN at all: each try may start a search for its module.
  static constexpr std::int64_t kPeriodWithoutCan_ns = 10'000'000'000;
  /// After bus-off the kernel's view of the link lags by up to a second.
  static constexpr std::int64_t kLinkLag_ns = 2'000'000'000;

  /// Tries to open it; `request.ids` must outlive the port.
  CanPort(const CanSocketRequest& request, const CanSystem& system) noexcept;

  /// Opens what is closed and looks at the link, if that is due; true if the socket is a new one.
  bool maintain(std::int64_t monotonic_ns) noexcept;

  [[nodiscard]] int socket() const noexcept { return socket_.number(); }
  /// What a call on the socket has come to.
  void failed(int error) noexcept;
  void worked() noexcept;

  // What the controller reports.
  void set_error_passive(bool is_passive) noexcept;
  void set_bus_off(std::int64_t monotonic_ns) noexcept;
  void set_restarted() noexcept;

  // For any thread.
  [[nodiscard]] BusState state() const noexcept { return state_.load(std::memory_order_relaxed); }
  [[nodiscard]] int error() const noexcept { return error_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t times_lost() const noexcept { return times_lost_; }

 private:
  bool open() noexcept;
  void follow(const CanLink& link, std::int64_t monotonic_ns) noexcept;
  void become(BusState state, int error) noexcept;

  CanSocketRequest request_;
  const CanSystem& system_;
  FileDescriptor socket_;
  std::int64_t due_ns_ = std::numeric_limits<std::int64_t>::min();
  std::int64_t bus_off_ns_ = 0;  ///< when the controller told of it

  // Relaxed: each stands for itself, nothing else is read because of it. Written by the using thread alone.
  std::atomic<BusState> state_{BusState::missing};
  std::atomic<int> error_{0};
  RelaxedCounter times_lost_;
};

}  // namespace landfix::platform
