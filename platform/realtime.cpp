#include "platform/realtime.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace landfix::platform {
namespace {

constexpr std::string_view kHowToGiveRights =
    "run it as the service landfixd, or give its file the rights: "
    "setcap cap_sys_nice,cap_ipc_lock+ep FILE";

/// "0-3,6": the cores that this process may use.
std::string allowed_cores() {
  cpu_set_t set{};
  if (::sched_getaffinity(0, sizeof set, &set) != 0) return "unknown";
  std::string text;
  for (std::size_t core = 0; core < CPU_SETSIZE; ++core) {
    if (!CPU_ISSET(core, &set)) continue;
    std::size_t last = core;
    while (last + 1 < CPU_SETSIZE && CPU_ISSET(last + 1, &set)) ++last;
    if (!text.empty()) text += ',';
    text += last == core ? fmt::format("{}", core) : fmt::format("{}-{}", core, last);
    core = last;
  }
  return text;
}

}  // namespace

Missing lock_memory() {
  // Without MCL_FUTURE: with it, the whole stack of every thread to come would be in memory.
  if (::mlockall(MCL_CURRENT) == 0) return std::nullopt;
  return fmt::format("memory is not locked, pages may be missing when they are needed ({}): {}, or raise {}",
                     std::strerror(errno), kHowToGiveRights, "LimitMEMLOCK");
}

void keep_heap_pages() noexcept {
  ::mallopt(M_TRIM_THRESHOLD, -1);
  ::mallopt(M_MMAP_MAX, 0);
}

Missing set_priority(pthread_t id, std::string_view thread, int priority) {
  sched_param parameter{};
  parameter.sched_priority = priority;
  const int error = ::pthread_setschedparam(id, priority == 0 ? SCHED_OTHER : SCHED_FIFO, &parameter);
  if (error == 0) return std::nullopt;
  return fmt::format(
      "thread {} has no real-time priority, others may delay it (SCHED_FIFO {}: {}): {}, or raise {}", thread,
      priority, std::strerror(error), kHowToGiveRights, "LimitRTPRIO");
}

Missing set_core(pthread_t id, std::string_view thread, int core) {
  if (core < 0) return std::nullopt;
  cpu_set_t set{};
  CPU_ZERO(&set);
  if (core < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(core), &set);
  const int error = ::pthread_setaffinity_np(id, sizeof set, &set);
  if (error == 0) return std::nullopt;
  return fmt::format("thread {} is not bound to core {} ({}): choose realtime.{}_core of {}", thread, core,
                     std::strerror(error), thread, allowed_cores());
}

void use_precise_timers() noexcept { ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL); }

void flush_denormals() noexcept {
#if defined(__x86_64__)
  constexpr unsigned kFlushToZero = 0x8000;
  constexpr unsigned kDenormalsAreZero = 0x0040;
  _mm_setcsr(_mm_getcsr() | kFlushToZero | kDenormalsAreZero);
#elif defined(__aarch64__)
  constexpr std::uint64_t kFlushToZero = 1ULL << 24;
  std::uint64_t control = 0;
  __asm__ volatile("mrs %0, fpcr" : "=r"(control));
  __asm__ volatile("msr fpcr, %0" : : "r"(control | kFlushToZero));
#endif
}

}  // namespace landfix::platform
