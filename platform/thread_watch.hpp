// What a real-time thread shows of itself while it runs: that it is alive, and that since start-up it has
// called no heap, locked no mutex and faulted no page.
#pragma once

#include <cstdint>

#include "platform/heap_counter.hpp"
#include "platform/monotonic_clock.hpp"
#include "platform/page_faults.hpp"
#include "platform/relaxed_counter.hpp"
#include "platform/watchdog.hpp"

namespace landfix::platform {

/// The thread itself calls begin() and then the rest; anyone may read the counts.
class ThreadWatch {
 public:
  /// Start-up is over.
  void begin() noexcept {
    beat();
    faults_before_ = faults();
    calls_before_ = HeapCounter::calls();
    locks_before_ = HeapCounter::locks();
    HeapCounter::arm();
  }
  void end() noexcept {
    HeapCounter::disarm();
    look();
  }

  /// Once a turn of the thread's loop.
  void beat() noexcept { heartbeat_.mark(monotonic_ns()); }
  /// Once a sweep or so: asks the kernel.
  void look() noexcept {
    page_faults_ = faults() - faults_before_;
    heap_calls_ = HeapCounter::calls() - calls_before_;
    locks_ = HeapCounter::locks() - locks_before_;
  }

  [[nodiscard]] const Heartbeat& heartbeat() const noexcept { return heartbeat_; }
  [[nodiscard]] std::uint64_t page_faults() const noexcept { return page_faults_; }
  // 0 where they cannot be counted (HeapCounter::available).
  [[nodiscard]] std::uint64_t heap_calls() const noexcept { return heap_calls_; }
  [[nodiscard]] std::uint64_t locks() const noexcept { return locks_; }

 private:
  [[nodiscard]] static std::uint64_t faults() noexcept {
    const PageFaults all = thread_page_faults();
    return static_cast<std::uint64_t>(all.minor + all.major);
  }

  std::uint64_t faults_before_ = 0;
  std::uint64_t calls_before_ = 0;
  std::uint64_t locks_before_ = 0;
  Heartbeat heartbeat_;
  RelaxedCounter page_faults_;
  RelaxedCounter heap_calls_;
  RelaxedCounter locks_;
};

}  // namespace landfix::platform
