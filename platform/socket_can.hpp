// The bus itself: frames into a CAN interface of the kernel, which may be missing, go and come back.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <linux/can.h>

#include "platform/bus_status.hpp"
#include "platform/can_frame.hpp"
#include "platform/can_port.hpp"
#include "platform/can_socket.hpp"
#include "platform/relaxed_counter.hpp"

namespace landfix::platform {

/// Sends without waiting. What finds the queue full or the bus down is dropped and counted: by the time there
/// is room there is a newer pose. One thread sends and maintains; any may read the status.
class SocketCan final : public FrameSink {
 public:
  /// `fd`: frames of CAN FD may come. Whether there is such an interface, `status` says.
  SocketCan(std::string_view interface, bool fd, const CanSystem& system = linux_can()) noexcept;
  ~SocketCan() override;  // the first virtual one: where it is defined the compiler puts what deletes
  SocketCan(const SocketCan&) = delete;
  SocketCan& operator=(const SocketCan&) = delete;

  /// The time is not needed: the bus has its own.
  [[nodiscard]] std::size_t send(std::span<const CanFrame> group,
                                 std::int64_t stamp_utc_ns) noexcept override;

  /// Reads what the controller tells of the bus, and opens the interface anew where it was lost.
  void maintain(std::int64_t monotonic_ns) noexcept override;

  /// For any thread.
  [[nodiscard]] BusStatus status() const noexcept;

 private:
  void read_errors(std::int64_t monotonic_ns) noexcept;
  void take_error_frame(const can_frame& frame, std::int64_t monotonic_ns) noexcept;
  void count_dropped(std::size_t frames, int error) noexcept;

  CanSocketRequest error_request_;
  const CanSystem& system_;
  CanPort port_;
  FileDescriptor errors_;
  RelaxedCounter frames_sent_;
  RelaxedCounter dropped_queue_full_;
  RelaxedCounter dropped_bus_down_;
};

}  // namespace landfix::platform
