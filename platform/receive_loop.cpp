#include "platform/receive_loop.hpp"

#include "platform/monotonic_clock.hpp"
#include "platform/sleep_until.hpp"

namespace landfix::platform {

void ReceiveLoop::run() noexcept {
  constexpr std::int64_t kLongestWait_ns = 100'000'000;
  constexpr unsigned kTurnsALook = 128;
  watch_.begin();
  unsigned turns = 0;
  while (!links_.stop.load(std::memory_order_relaxed)) {
    watch_.beat();
    if (++turns % kTurnsALook == 0) watch_.look();
    const ReceiveStatus status = receiver_.receive(links_.packets, monotonic_ns() + kLongestWait_ns);
    if (status == ReceiveStatus::packets) links_.packets_bell.ring();
    if (status == ReceiveStatus::failed) sleep_until(monotonic_ns() + kLongestWait_ns);
    if (status != ReceiveStatus::end && status != ReceiveStatus::truncated) continue;
    ending_.store(status, std::memory_order_relaxed);
    break;
  }
  watch_.end();
  links_.packets_ended.store(true, std::memory_order_release);
  links_.packets_bell.ring();
}

}  // namespace landfix::platform
