#include "platform/doorbell.hpp"

#include <ctime>

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace landfix::platform {
namespace {

constexpr std::int64_t kNs_per_s = 1'000'000'000;

}  // namespace

void Doorbell::ring() noexcept {
  count_.fetch_add(1, std::memory_order_release);
  ::syscall(SYS_futex, &count_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

void Doorbell::wait(std::uint32_t seen, std::int64_t deadline_mono_ns) noexcept {
  const timespec deadline{.tv_sec = deadline_mono_ns / kNs_per_s, .tv_nsec = deadline_mono_ns % kNs_per_s};
  // The only FUTEX_WAIT whose deadline is a time and not a duration.
  ::syscall(SYS_futex, &count_, FUTEX_WAIT_BITSET_PRIVATE, seen, &deadline, nullptr, FUTEX_BITSET_MATCH_ANY);
}

}  // namespace landfix::platform
