// Two buffers between a writer and a reader, each thread at its own pace: the reader always has a finished
// one, the writer fills the other. No lock, no wait, and no third buffer, which for a map would be dear; the
// price is that the writer cannot begin anew before the reader has taken what it finished last.
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>

namespace landfix::platform {

/// Which of the two buffers belongs to whom; they themselves lie elsewhere.
class HandOver {
 public:
  /// For the writer: the buffer that it may write to; nothing while the last one has not been taken.
  [[nodiscard]] std::optional<std::size_t> writable() const noexcept {
    // acquire, pairs with the release in newest(): what the reader read of its old buffer is read before it
    // is written to again.
    if (is_fresh_.load(std::memory_order_acquire)) return std::nullopt;
    return writers_;
  }
  /// For the writer: the buffer of writable() is finished.
  void publish() noexcept {
    writers_ ^= 1U;
    // release, pairs with the acquire in newest(): the reader sees the finished buffer.
    is_fresh_.store(true, std::memory_order_release);
  }

  /// For the reader: the buffer that was finished last. It stays as it is until this is called again.
  [[nodiscard]] std::size_t newest() noexcept {
    if (is_fresh_.load(std::memory_order_acquire)) {
      readers_ ^= 1U;
      is_fresh_.store(false, std::memory_order_release);
    }
    return readers_;
  }

 private:
  static_assert(std::atomic<bool>::is_always_lock_free);

  // Set by the writer alone and cleared by the reader alone: each change hands one buffer over.
  alignas(64) std::atomic<bool> is_fresh_{false};
  alignas(64) std::size_t writers_ = 0;
  alignas(64) std::size_t readers_ = 1;
};

}  // namespace landfix::platform
