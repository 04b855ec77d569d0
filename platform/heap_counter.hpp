// Counts the calls of the heap, and the mutexes that are locked, by a thread while it asks for it: the proof
// that there are none after start-up. It counts in executables that link landfix_heap_counter, which puts
// itself before the C library's malloc, free and the rest (C++'s new and delete call these), and before
// pthread_mutex_lock (which std::mutex calls).
#pragma once

#include <cstdint>

namespace landfix::platform {

/// All of it concerns the calling thread alone.
class HeapCounter {
 public:
  /// False where the calls cannot be counted: not linked, not glibc, or a sanitizer owns the heap.
  [[nodiscard]] static bool available() noexcept { return available_; }

  static void arm() noexcept;
  static void disarm() noexcept;

  /// While armed, since the thread began.
  [[nodiscard]] static std::uint64_t calls() noexcept;
  [[nodiscard]] static std::uint64_t locks() noexcept;

  /// For landfix_heap_counter.
  static void count() noexcept {
    if (thread_.armed) ++thread_.calls;
  }
  static void count_lock() noexcept {
    if (thread_.armed) ++thread_.locks;
  }
  static void make_available() noexcept { available_ = true; }

 private:
  struct Thread {
    bool armed = false;
    std::uint64_t calls = 0;
    std::uint64_t locks = 0;
  };
  static constinit thread_local Thread thread_;
  static constinit bool available_;
};

}  // namespace landfix::platform
