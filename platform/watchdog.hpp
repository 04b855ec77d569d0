// Whether every thread still does its work: each marks the time whenever it comes round, and has a budget for
// coming round again. A thread without work comes round too: it wakes to look (rx at least every 100 ms).
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <span>
#include <string_view>

namespace landfix::platform {

/// Marked by one thread, read by any.
class Heartbeat {
 public:
  void mark(std::int64_t now_ns) noexcept {
    // relaxed: the time itself is all that is told, no other data hangs on it.
    marked_ns_.store(now_ns, std::memory_order_relaxed);
  }
  [[nodiscard]] std::int64_t marked_ns() const noexcept {
    return marked_ns_.load(std::memory_order_relaxed);  // see mark()
  }

 private:
  static_assert(std::atomic<std::int64_t>::is_always_lock_free);
  // A line of its own: whoever reads it must not slow down what its neighbours are written by.
  alignas(64) std::atomic<std::int64_t> marked_ns_{0};
};

/// A row of the table that a watchdog goes by.
struct WatchedThread {
  std::string_view name;
  std::int64_t budget_ns = 0;  ///< longest time from one mark to the next
  const Heartbeat* heartbeat = nullptr;
};

/// The first thread that is over its budget at `now_ns`, of the clock that marks; none: null. Before its
/// first mark a thread counts as having marked at 0, so mark all of them before the first look.
[[nodiscard]] constexpr const WatchedThread* find_late(std::span<const WatchedThread> threads,
                                                       std::int64_t now_ns) noexcept {
  const auto late = std::find_if(threads.begin(), threads.end(), [now_ns](const WatchedThread& thread) {
    return now_ns - thread.heartbeat->marked_ns() > thread.budget_ns;
  });
  return late == threads.end() ? nullptr : &*late;
}

}  // namespace landfix::platform
