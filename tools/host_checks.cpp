#include "tools/host_checks.hpp"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/host_files.hpp"

namespace landfix::tools {
namespace {

namespace fs = std::filesystem;

struct Host {
  const fs::path& root;
  const HostNeeds& needs;
};

HostCheck unknown(std::string name, std::string_view file) {
  return {std::move(name), Verdict::unknown, fmt::format("no {} here", file)};
}

HostCheck judge(std::string name, bool passes, std::string found, std::string mend) {
  if (passes) return {std::move(name), Verdict::pass, std::move(found)};
  return {std::move(name), Verdict::warn, std::move(found), std::move(mend)};
}

HostCheck check_kernel(const Host& host) {
  const auto version = read_host_file(host.root / "proc/version");
  if (!version) return unknown("kernel", "/proc/version");
  const auto realtime = read_host_number(host.root / "sys/kernel/realtime");
  const bool is_realtime = realtime == 1 || version->find("PREEMPT_RT") != version->npos;
  const bool is_dynamic = version->find("PREEMPT_DYNAMIC") != version->npos;
  return judge("kernel", is_realtime,
               is_realtime  ? "PREEMPT_RT"
               : is_dynamic ? "PREEMPT_DYNAMIC"
                            : "neither PREEMPT_RT nor PREEMPT_DYNAMIC",
               "apt-get install linux-image-rt-amd64 (or -arm64)");
}

/// Whether all cores that threads are bound to are of `list`.
HostCheck check_cores(const Host& host, std::string name, const std::optional<std::string>& list,
                      std::string_view parameter) {
  if (host.needs.cores.empty()) {
    return {std::move(name), Verdict::pass, "not needed: [realtime] binds no thread to a core"};
  }
  const std::vector<int> there = parse_cores(list.value_or(""));
  const bool all = std::all_of(host.needs.cores.begin(), host.needs.cores.end(), [&there](int core) {
    return std::find(there.begin(), there.end(), core) != there.end();
  });
  return judge(std::move(name), all, there.empty() ? "none" : *list,
               fmt::format("boot with {}={}", parameter, fmt::join(host.needs.cores, ",")));
}

HostCheck check_isolated(const Host& host) {
  return check_cores(host, "isolated cores", read_host_file(host.root / "sys/devices/system/cpu/isolated"),
                     "isolcpus");
}

HostCheck check_tickless(const Host& host) {
  return check_cores(host, "tickless cores", read_host_file(host.root / "sys/devices/system/cpu/nohz_full"),
                     "nohz_full");
}

HostCheck check_rcu(const Host& host) {
  std::istringstream words(read_host_file(host.root / "proc/cmdline").value_or(""));
  constexpr std::string_view kKey = "rcu_nocbs=";
  std::optional<std::string> list;
  for (std::string word; words >> word;) {
    if (word.starts_with(kKey)) list = word.substr(kKey.size());
  }
  return check_cores(host, "cores without RCU callbacks", list, "rcu_nocbs");
}

HostCheck check_governor(const Host& host) {
  std::optional<std::string> found;
  for (const fs::path& core : host_entries(host.root / "sys/devices/system/cpu", "cpu")) {
    const auto governor = read_host_file(core / "cpufreq/scaling_governor");
    if (governor && (!found || *governor != "performance")) found = governor;
  }
  if (!found) return unknown("frequency governor", "cpufreq");
  return judge("frequency governor", *found == "performance", *found,
               "cpupower frequency-set --governor performance");
}

HostCheck check_idle_states(const Host& host) {
  constexpr std::int64_t kShort_us = 50;
  std::optional<std::int64_t> longest_us;
  for (const fs::path& state : host_entries(host.root / "sys/devices/system/cpu/cpu0/cpuidle", "state")) {
    const auto latency_us = read_host_number(state / "latency");
    if (!latency_us || read_host_number(state / "disable") == 1) continue;
    longest_us = std::max(longest_us.value_or(0), *latency_us);
  }
  if (!longest_us) return unknown("idle states", "cpuidle");
  return judge("idle states", *longest_us <= kShort_us,
               fmt::format("a core takes up to {} us to wake", *longest_us),
               fmt::format("hold /dev/cpu_dma_latency (tuned-adm profile latency-performance), or cpupower "
                           "idle-set --disable-by-latency {}",
                           kShort_us));
}

HostCheck check_smt(const Host& host) {
  const auto active = read_host_number(host.root / "sys/devices/system/cpu/smt/active");
  if (!active) return unknown("hyper-threads", "/sys/devices/system/cpu/smt");
  return judge("hyper-threads", *active == 0, *active == 0 ? "off" : "on: two threads share a core",
               "echo off > /sys/devices/system/cpu/smt/control, or boot with nosmt");
}

HostCheck check_huge_pages(const Host& host) {
  const auto text = read_host_file(host.root / "sys/kernel/mm/transparent_hugepage/enabled");
  if (!text) return unknown("huge pages", "/sys/kernel/mm/transparent_hugepage");
  const std::string mode = bracketed(*text);
  return judge("huge pages", mode == "madvise", mode,
               "echo madvise > /sys/kernel/mm/transparent_hugepage/enabled");
}

HostCheck check_receive_buffer(const Host& host) {
  const auto bytes = read_host_number(host.root / "proc/sys/net/core/rmem_max");
  if (!bytes) return unknown("receive buffer", "/proc/sys/net/core/rmem_max");
  const auto wanted = static_cast<std::int64_t>(host.needs.receive_bytes);
  return judge("receive buffer", *bytes >= wanted,
               fmt::format("at most {} bytes; the sensor needs {}", *bytes, wanted),
               fmt::format("sysctl -w net.core.rmem_max={}", wanted));
}

HostCheck check_throttling(const Host& host) {
  constexpr std::int64_t kEnough_us = 900'000;
  const auto runtime_us = read_host_number(host.root / "proc/sys/kernel/sched_rt_runtime_us");
  if (!runtime_us) return unknown("real-time share", "/proc/sys/kernel/sched_rt_runtime_us");
  return judge("real-time share", *runtime_us < 0 || *runtime_us >= kEnough_us,
               *runtime_us < 0 ? "not limited" : fmt::format("{} of 1000 ms", *runtime_us / 1000),
               "sysctl -w kernel.sched_rt_runtime_us=950000");
}

HostCheck check_swap(const Host& host) {
  const auto text = read_host_file(host.root / "proc/swaps");
  if (!text) return unknown("swap", "/proc/swaps");
  const bool none = text->find('\n') == text->npos;  // only the heading
  return judge("swap", none, none ? "none" : "on", "swapoff --all, and take it out of /etc/fstab");
}

HostCheck check_clock_source(const Host& host) {
  const auto source =
      read_host_file(host.root / "sys/devices/system/clocksource/clocksource0/current_clocksource");
  if (!source) return unknown("clock source", "/sys/devices/system/clocksource");
  // Those that are read through a bus, with a system call each time.
  const bool slow = *source == "hpet" || *source == "acpi_pm" || *source == "jiffies";
  return judge("clock source", !slow, *source,
               "boot with clocksource=tsc tsc=reliable, if the TSC is stable");
}

HostCheck check_can_interface(const Host& host) {
  constexpr std::int64_t kInterfaceIsUp = 1;
  const std::string& name = host.needs.can_interface;
  const fs::path folder = host.root / "sys/class/net" / name;
  const auto flags = read_host_number(folder / "flags");
  if (!flags) {
    return {"CAN interface", Verdict::warn, fmt::format("no {} here", name),
            fmt::format("load the driver, or name another in [can] interface; ip link lists them")};
  }
  const auto length = read_host_number(folder / "tx_queue_len").value_or(0);
  return judge("CAN interface", (*flags & kInterfaceIsUp) != 0,
               fmt::format("{} is {}, queue of {} frames", name,
                           (*flags & kInterfaceIsUp) != 0 ? "up" : "down", length),
               fmt::format("ip link set {} up type can bitrate 500000 restart-ms 100", name));
}

HostCheck check_can_queue(const Host& host) {
  constexpr std::int64_t kTwoPoses = 12;  // of six frames
  const std::string& name = host.needs.can_interface;
  const auto length = read_host_number(host.root / "sys/class/net" / name / "tx_queue_len");
  if (!length) return unknown("CAN queue", name);
  return judge("CAN queue", *length >= kTwoPoses, fmt::format("{} frames", *length),
               fmt::format("ip link set {} txqueuelen 16", name));
}

/// The cores that take the interrupts of the Ethernet to the sensor: none that a real-time thread is bound
/// to.
HostCheck check_interrupts(const Host& host) {
  const std::string& name = host.needs.sensor_interface;
  std::vector<int> cores;
  for (const fs::path& irq : host_entries(host.root / "sys/class/net" / name / "device/msi_irqs", "")) {
    const auto list = read_host_file(host.root / "proc/irq" / irq.filename() / "smp_affinity_list");
    for (const int core : parse_cores(list.value_or(""))) cores.push_back(core);
  }
  if (cores.empty()) return {"interrupts", Verdict::unknown, fmt::format("none of {} to be seen", name)};
  std::sort(cores.begin(), cores.end());
  cores.erase(std::unique(cores.begin(), cores.end()), cores.end());
  const bool apart = std::none_of(cores.begin(), cores.end(), [&host](int core) {
    return std::find(host.needs.cores.begin(), host.needs.cores.end(), core) != host.needs.cores.end();
  });
  return judge("interrupts", apart, fmt::format("{} on cores {}", name, fmt::join(cores, ",")),
               fmt::format("write other cores to /proc/irq/N/smp_affinity_list for N in "
                           "/sys/class/net/{}/device/msi_irqs, and ban ours in irqbalance",
                           name));
}

}  // namespace

const char* to_string(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::pass:
      return "PASS";
    case Verdict::warn:
      return "WARN";
    case Verdict::unknown:
      break;
  }
  return "?";
}

std::vector<HostCheck> check_host(const fs::path& root, const HostNeeds& needs) {
  const Host host{root, needs};
  std::vector<HostCheck> checks;
  for (const auto check :
       {check_kernel, check_isolated, check_tickless, check_rcu, check_governor, check_idle_states, check_smt,
        check_huge_pages, check_throttling, check_swap, check_clock_source, check_receive_buffer}) {
    checks.push_back(check(host));
  }
  if (!needs.sensor_interface.empty()) checks.push_back(check_interrupts(host));
  if (!needs.can_interface.empty()) {
    checks.push_back(check_can_interface(host));
    checks.push_back(check_can_queue(host));
  }
  return checks;
}

}  // namespace landfix::tools
