// Frames from a CAN interface, with the kernel's time of their receipt. The kernel lets through the wanted
// identifiers alone. The interface may be missing, go and come back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "platform/can_frame.hpp"
#include "platform/can_port.hpp"
#include "platform/can_socket.hpp"
#include "platform/relaxed_counter.hpp"

namespace landfix::platform {

/// One thread receives and maintains; any may read the state and the counters.
class CanReceiver final : public FrameSource {
 public:
  static constexpr std::size_t kMaxIds = 64;

  /// `ids`: at most kMaxIds, the rest is left out; none: every frame. Classic and CAN FD alike. Whether there
  /// is such an interface, `state` says.
  CanReceiver(std::string_view interface, std::span<const CanId> ids,
              const CanSystem& system = linux_can()) noexcept;
  ~CanReceiver() override;  // the first virtual one: where it is defined the compiler puts what deletes
  CanReceiver(const CanReceiver&) = delete;
  CanReceiver& operator=(const CanReceiver&) = delete;

  /// The next frame; false if there is none now. Never waits.
  [[nodiscard]] bool receive(CanFrame& frame, std::int64_t& stamp_utc_ns) noexcept;

  /// To be called every 100 ms or more often: opens the interface anew where it was lost. Never waits.
  void maintain(std::int64_t monotonic_ns) noexcept override { (void)port_.maintain(monotonic_ns); }
  [[nodiscard]] bool next(StampedFrame& frame, std::int64_t /*now_utc_ns*/) noexcept override {
    return receive(frame.frame, frame.stamp_utc_ns);
  }

  /// To wait on with poll(2), until the next `receive` or `maintain`; negative: none, the interface is
  /// missing.
  [[nodiscard]] int descriptor() const noexcept { return port_.socket(); }

  // For any thread.
  [[nodiscard]] BusState state() const noexcept { return port_.state(); }
  [[nodiscard]] int error() const noexcept { return port_.error(); }  ///< errno that made it so; 0: none
  [[nodiscard]] std::uint64_t frames_received() const noexcept { return frames_received_; }
  /// That the kernel had no room for, because none were fetched.
  [[nodiscard]] std::uint64_t frames_overflowed() const noexcept { return frames_overflowed_; }
  [[nodiscard]] std::uint64_t times_lost() const noexcept { return port_.times_lost(); }

 private:
  struct Ids {
    explicit Ids(std::span<const CanId> wanted) noexcept;
    [[nodiscard]] std::span<const CanId> all() const noexcept { return std::span(ids).first(count); }

    std::array<CanId, kMaxIds> ids{};
    std::size_t count = 0;
  };

  void take_overflow(std::uint32_t overflowed) noexcept;

  Ids ids_;
  CanPort port_;
  std::uint32_t last_overflow_ = 0;  ///< the kernel's count, which starts anew with each socket
  RelaxedCounter frames_received_;
  RelaxedCounter frames_overflowed_;
};

}  // namespace landfix::platform
