// The protocol of a queue between one producer and one consumer: who may touch which slots, without a lock.
// Proven by exhaustion in test/proofs, where each order below is weakened in turn and must fail.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace landfix::platform {

/// Why each access to the two counts has the order that it has.
struct SpscOrders {
  // The producer's slots are written before the consumer, seeing the count, reads them.
  static constexpr std::memory_order kPublish = std::memory_order_release;
  static constexpr std::memory_order kSeePublished = std::memory_order_acquire;  // pairs with kPublish
  // The consumer's slots are read before the producer, seeing the count, writes them again.
  static constexpr std::memory_order kFree = std::memory_order_release;
  static constexpr std::memory_order kSeeFreed = std::memory_order_acquire;  // pairs with kFree
};

/// Two counts that only ever rise; what lies between them belongs to the consumer, the rest to the producer.
/// The slots lie elsewhere. Each side looks at the other's count only when the last look no longer suffices.
template <class Orders = SpscOrders, template <class> class Atomic = std::atomic>
class SpscIndices {
 public:
  /// `capacity`: slots, a power of two.
  explicit SpscIndices(std::size_t capacity) noexcept : capacity_(capacity) {}

  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

  /// For the producer: how many slots it may write now, at least `wanted` if there are so many.
  [[nodiscard]] std::size_t writable(std::size_t wanted) noexcept {
    std::uint64_t free = capacity_ - (published_by_producer_ - freed_seen_);
    if (free < wanted) {
      freed_seen_ = freed_.load(Orders::kSeeFreed);
      free = capacity_ - (published_by_producer_ - freed_seen_);
    }
    return static_cast<std::size_t>(free);
  }
  /// For the producer: the slot of the i-th that it may write.
  [[nodiscard]] std::size_t write_slot(std::size_t i) const noexcept {
    return static_cast<std::size_t>(published_by_producer_ + i) & (capacity_ - 1);
  }
  /// For the producer: hands over the next `count` slots.
  void publish(std::size_t count) noexcept {
    published_by_producer_ += count;
    published_.store(published_by_producer_, Orders::kPublish);
  }

  /// For the consumer: how many slots it may read now, at least `wanted` if there are so many.
  [[nodiscard]] std::size_t readable(std::size_t wanted) noexcept {
    std::uint64_t full = published_seen_ - freed_by_consumer_;
    if (full < wanted) {
      published_seen_ = published_.load(Orders::kSeePublished);
      full = published_seen_ - freed_by_consumer_;
    }
    return static_cast<std::size_t>(full);
  }
  /// For the consumer: the slot of the i-th that it may read.
  [[nodiscard]] std::size_t read_slot(std::size_t i) const noexcept {
    return static_cast<std::size_t>(freed_by_consumer_ + i) & (capacity_ - 1);
  }
  /// For the consumer: gives back the oldest `count` slots.
  void free(std::size_t count) noexcept {
    freed_by_consumer_ += count;
    freed_.store(freed_by_consumer_, Orders::kFree);
  }

 private:
  std::uint64_t capacity_;
  // Each side's line in the cache: its own count, and what it last saw of the other's.
  alignas(64) Atomic<std::uint64_t> published_{0};
  std::uint64_t published_by_producer_ = 0;
  std::uint64_t freed_seen_ = 0;
  alignas(64) Atomic<std::uint64_t> freed_{0};
  std::uint64_t freed_by_consumer_ = 0;
  std::uint64_t published_seen_ = 0;
};

static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

}  // namespace landfix::platform
