// The latest value from one thread to one other: the writer never waits for the reader, nor the reader for
// the writer, and no value is ever torn. Proven by exhaustion in test/proofs.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace landfix::platform {

struct TripleBufferOrders {
  // The writer's buffer is written before the reader, taking it, reads it; and by the same exchange the
  // buffer that the writer gets back was read by the reader before it is written again.
  static constexpr std::memory_order kPublish = std::memory_order_acq_rel;  // pairs with kTake
  static constexpr std::memory_order kTake = std::memory_order_acq_rel;     // pairs with kPublish
};

/// Three buffers: the writer's, the reader's, and the middle one, which they exchange for their own.
template <class T, class Orders = TripleBufferOrders, template <class> class Atomic = std::atomic>
class TripleBuffer {
 public:
  /// For the writer: the buffer to fill; what it holds is old.
  [[nodiscard]] T& back() noexcept { return buffers_[back_]; }
  /// For the writer: makes it the latest.
  void publish() noexcept {
    back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), Orders::kPublish) & kIndex;
  }

  /// For the reader: whether there is a newer value than the last that it took, which front() then is.
  [[nodiscard]] bool update() noexcept {
    // relaxed: only a hint; what it leads to is ordered by the exchange.
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, Orders::kTake) & kIndex;
    return true;
  }
  [[nodiscard]] const T& front() const noexcept { return buffers_[front_]; }

 private:
  static_assert(std::atomic<std::uint8_t>::is_always_lock_free);
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;

  std::array<T, 3> buffers_{};
  alignas(64) Atomic<std::uint8_t> middle_{1};
  alignas(64) std::uint8_t back_ = 0;
  alignas(64) std::uint8_t front_ = 2;
};

}  // namespace landfix::platform
