// Two buffers between a writer and a reader, each thread at its own pace: the reader always has a finished
// one, the writer fills the other. No lock, no wait, and no third buffer, which for a map would be dear; the
// price is that the writer cannot begin anew before the reader has taken what it finished last. Proven by
// exhaustion in test/proofs, where each order below is weakened in turn and must fail.
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>

namespace landfix::platform {

struct HandOverOrders {
  // The finished buffer is written before the reader, seeing that it is fresh, reads it.
  static constexpr std::memory_order kPublish = std::memory_order_release;
  static constexpr std::memory_order kSeePublished = std::memory_order_acquire;  // pairs with kPublish
  // The reader's old buffer is read before the writer, seeing that the new one is taken, writes to it.
  static constexpr std::memory_order kTake = std::memory_order_release;
  static constexpr std::memory_order kSeeTaken = std::memory_order_acquire;  // pairs with kTake
};

/// Which of the two buffers belongs to whom; they themselves lie elsewhere.
template <class Orders, template <class> class Atomic>
class HandOverOf {
 public:
  /// For the writer: the buffer that it may write to; nothing while the last one has not been taken.
  [[nodiscard]] std::optional<std::size_t> writable() const noexcept {
    if (is_fresh_.load(Orders::kSeeTaken)) return std::nullopt;
    return writers_;
  }
  /// For the writer: the buffer of writable() is finished.
  void publish() noexcept {
    writers_ ^= 1U;
    is_fresh_.store(true, Orders::kPublish);
  }

  /// For the reader: the buffer that was finished last. It stays as it is until this is called again.
  [[nodiscard]] std::size_t newest() noexcept {
    if (is_fresh_.load(Orders::kSeePublished)) {
      readers_ ^= 1U;
      is_fresh_.store(false, Orders::kTake);
    }
    return readers_;
  }

 private:
  static_assert(std::atomic<bool>::is_always_lock_free);

  // Set by the writer alone and cleared by the reader alone: each change hands one buffer over.
  alignas(64) Atomic<bool> is_fresh_{false};
  alignas(64) std::size_t writers_ = 0;
  alignas(64) std::size_t readers_ = 1;
};

using HandOver = HandOverOf<HandOverOrders, std::atomic>;

}  // namespace landfix::platform
