// How one thread wakes another that has nothing to do: a count in memory that the kernel watches (futex), so
// that ringing never waits and no ring between looking and sleeping is missed.
#pragma once

#include <atomic>
#include <cstdint>

namespace landfix::platform {

class Doorbell {
 public:
  /// For whoever has left something to do. Never waits.
  void ring() noexcept;

  /// For the sleeper, before it looks for something to do.
  [[nodiscard]] std::uint32_t count() const noexcept {
    // acquire, pairs with the release in ring(): what was left before the ring is seen after it.
    return count_.load(std::memory_order_acquire);
  }
  /// Sleeps until a ring after `seen`, or until `deadline_mono_ns`, whichever is first; may wake for nothing.
  void wait(std::uint32_t seen, std::int64_t deadline_mono_ns) noexcept;

 private:
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free);
  static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t), "a futex is 32 bits");

  alignas(64) std::atomic<std::uint32_t> count_{0};
};

}  // namespace landfix::platform
