// A number that one thread counts and any other may read: it is never torn, and says nothing of what else the
// counting thread has done by then.
#pragma once

#include <atomic>
#include <cstdint>

namespace landfix::platform {

/// Counts as a plain integer does, without a locked instruction: only one thread may change it.
class RelaxedCounter {
 public:
  constexpr RelaxedCounter(std::uint64_t value = 0) noexcept : value_(value) {}
  RelaxedCounter(const RelaxedCounter& other) noexcept : value_(other) {}
  RelaxedCounter& operator=(const RelaxedCounter& other) noexcept { return *this = std::uint64_t{other}; }
  RelaxedCounter& operator=(std::uint64_t value) noexcept {
    value_.store(value, std::memory_order_relaxed);
    return *this;
  }
  ~RelaxedCounter() = default;

  RelaxedCounter& operator+=(std::uint64_t more) noexcept { return *this = *this + more; }
  RelaxedCounter& operator++() noexcept { return *this += 1; }
  operator std::uint64_t() const noexcept { return value_.load(std::memory_order_relaxed); }

 private:
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
  std::atomic<std::uint64_t> value_;
};

}  // namespace landfix::platform
