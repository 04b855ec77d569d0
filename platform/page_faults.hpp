// How often the kernel had to provide a page to the calling thread: none after start-up, if memory is locked.
#pragma once

#include <cstdint>

#include <sys/resource.h>

namespace landfix::platform {

struct PageFaults {
  std::int64_t minor = 0;  ///< the page was in memory
  std::int64_t major = 0;  ///< it had to be read from disk
};

/// Of the calling thread, since it began.
[[nodiscard]] inline PageFaults thread_page_faults() noexcept {
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  return {.minor = usage.ru_minflt, .major = usage.ru_majflt};
}

}  // namespace landfix::platform
