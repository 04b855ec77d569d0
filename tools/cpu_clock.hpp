// How long something takes, whatever else the machine does meanwhile.
#pragma once

#include <ctime>

namespace landfix::tools {

/// CPU time of all threads of this process [ms]: what works in several is charged for each.
[[nodiscard]] inline double process_cpu_ms() noexcept {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

/// CPU time of a call [ms].
template <class Call>
[[nodiscard]] double cpu_ms_of(Call&& call) {
  const double began_ms = process_cpu_ms();
  call();
  return process_cpu_ms() - began_ms;
}

}  // namespace landfix::tools
