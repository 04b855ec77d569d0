#include "tools/host_rights.hpp"

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/timex.h>

#include "platform/realtime_thread.hpp"
#include "tools/queueing_discipline.hpp"

namespace landfix::tools {
namespace {

std::string limit_text(rlim_t limit) { return limit == RLIM_INFINITY ? "unlimited" : std::to_string(limit); }

/// The soft limit, as text.
std::string limit_of(__rlimit_resource resource) {
  rlimit limit{};
  return ::getrlimit(resource, &limit) == 0 ? limit_text(limit.rlim_cur) : "unknown";
}

HostCheck check_thread(const std::string& name, const platform::ThreadSchedule& schedule) {
  const platform::RealtimeThread thread({.name = name, .schedule = schedule}, []() noexcept {});
  const std::string row = fmt::format("thread {}", name);
  if (thread.missing().empty()) {
    const std::string core = schedule.core < 0 ? "any core" : fmt::format("core {}", schedule.core);
    return {row, Verdict::pass, fmt::format("SCHED_FIFO {}, {}", schedule.priority, core)};
  }
  return {row, Verdict::warn, fmt::format("RLIMIT_RTPRIO {}", limit_of(RLIMIT_RTPRIO)),
          fmt::format("{}", fmt::join(thread.missing(), "; "))};
}

HostCheck check_locking() {
  platform::Missing missing = platform::lock_memory();
  ::munlockall();
  if (missing) {
    return {"locked memory", Verdict::warn, fmt::format("RLIMIT_MEMLOCK {}", limit_of(RLIMIT_MEMLOCK)),
            *std::move(missing)};
  }
  return {"locked memory", Verdict::pass, "may lock its memory"};
}

}  // namespace

std::vector<HostCheck> check_rights(const platform::RealtimeSettings& realtime) {
  if (realtime.mode == platform::RealtimeMode::off) {
    return {{"rights", Verdict::pass, "not needed: [realtime] mode is \"off\""}};
  }
  std::vector<HostCheck> checks{check_thread("rx", realtime.rx), check_thread("solve", realtime.solve),
                                check_thread("tx", realtime.tx)};
  if (realtime.lock_memory) checks.push_back(check_locking());
  return checks;
}

HostCheck check_discipline(const std::string& can_interface) {
  const std::optional<std::string> found = queueing_discipline(can_interface);
  if (!found) return {"CAN queue's order", Verdict::unknown, fmt::format("no {} here", can_interface)};
  // These reorder flows or drop what has waited: for the Internet, not for a bus.
  const bool sorts = found->starts_with("fq") || *found == "sfq" || *found == "cake" || *found == "red";
  if (!sorts) return {"CAN queue's order", Verdict::pass, *found};
  return {"CAN queue's order", Verdict::warn, *found,
          fmt::format("tc qdisc replace dev {} root pfifo_fast", can_interface)};
}

HostCheck check_clock() {
  timex state{};  // no mode: it is only read
  const int status = ::adjtimex(&state);
  if (status < 0) return {"clock", Verdict::unknown, "adjtimex is not allowed here"};
  if (status == TIME_ERROR || (state.status & STA_UNSYNC) != 0) {
    return {"clock", Verdict::warn, "kept by nothing",
            "run chrony, or ptp4l and phc2sys (linuxptp) where the sensor has PTP too"};
  }
  return {"clock", Verdict::pass, fmt::format("kept, to {} us at worst", state.maxerror)};
}

}  // namespace landfix::tools
