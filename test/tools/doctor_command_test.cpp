#include <fstream>
#include <map>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/run_landfix.hpp"
#include "support/test_data.hpp"
#include "tools/host_checks.hpp"
#include "tools/host_files.hpp"
#include "tools/queueing_discipline.hpp"

namespace landfix::tools {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A host of our own making.
class HostChecksTest : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = root_.path() / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }

  /// As a vehicle's should be, but for what the tests change afterwards.
  void make_fit() const {
    write("proc/version", "Linux version 6.1.0-rt SMP PREEMPT_RT Debian\n");
    write("proc/cmdline", "quiet isolcpus=2,3 nohz_full=2-3 rcu_nocbs=2-3\n");
    write("proc/swaps", "Filename Type Size Used Priority\n");
    write("proc/sys/net/core/rmem_max", "8388608\n");
    write("proc/sys/kernel/sched_rt_runtime_us", "950000\n");
    write("proc/irq/40/smp_affinity_list", "0-1\n");
    write("sys/kernel/realtime", "1\n");
    write("sys/kernel/mm/transparent_hugepage/enabled", "always [madvise] never\n");
    write("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc\n");
    write("sys/devices/system/cpu/isolated", "2-3\n");
    write("sys/devices/system/cpu/nohz_full", "2-3\n");
    write("sys/devices/system/cpu/smt/active", "0\n");
    write("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance\n");
    write("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "performance\n");
    write("sys/devices/system/cpu/cpu0/cpuidle/state0/latency", "2\n");
    write("sys/devices/system/cpu/cpu0/cpuidle/state1/latency", "100\n");
    write("sys/devices/system/cpu/cpu0/cpuidle/state1/disable", "1\n");
    write("sys/class/net/can0/flags", "0x400c1\n");
    write("sys/class/net/can0/tx_queue_len", "100\n");
    write("sys/class/net/eth0/device/msi_irqs/40", "msi\n");
  }

  [[nodiscard]] std::map<std::string, HostCheck> check() const {
    std::map<std::string, HostCheck> checks;
    for (const HostCheck& row : check_host(root_.path(), needs_)) checks[row.name] = row;
    return checks;
  }

  void expect_warning(const std::string& name, const std::string& found, const std::string& mend) const {
    const HostCheck row = check()[name];
    EXPECT_EQ(row.verdict, Verdict::warn) << name << ": " << row.found;
    EXPECT_THAT(row.found, HasSubstr(found));
    EXPECT_THAT(row.mend, HasSubstr(mend));
  }

  test::TemporaryDirectory root_;
  HostNeeds needs_{
      .cores = {2, 3}, .receive_bytes = 4 << 20, .can_interface = "can0", .sensor_interface = "eth0"};
};

TEST_F(HostChecksTest, AFitHostPassesAllOfIt) {
  make_fit();
  for (const auto& [name, row] : check()) {
    EXPECT_EQ(row.verdict, Verdict::pass) << name << ": " << row.found;
    EXPECT_THAT(row.mend, IsEmpty()) << name;
  }
}

TEST_F(HostChecksTest, AHostThatSaysNothingIsUnknownButForWhatIsNeeded) {
  for (const auto& [name, row] : check()) {
    const bool needed = name == "CAN interface" || name.find("cores") != name.npos;
    EXPECT_EQ(row.verdict, needed ? Verdict::warn : Verdict::unknown) << name << ": " << row.found;
  }
}

TEST_F(HostChecksTest, FilesWithoutSenseAreSurvived) {
  make_fit();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root_.path())) {
    if (entry.is_regular_file()) std::ofstream(entry.path()) << "]\xff[ 99999999999999999999-,";
  }
  EXPECT_FALSE(check().empty());
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root_.path())) {
    if (entry.is_regular_file()) std::ofstream(entry.path(), std::ios::trunc);
  }
  EXPECT_FALSE(check().empty());
}

TEST_F(HostChecksTest, WhatIsAmissIsNamedWithItsMend) {
  make_fit();
  write("sys/kernel/realtime", "0\n");
  write("proc/version", "Linux version 6.1.0 SMP PREEMPT_DYNAMIC\n");
  expect_warning("kernel", "PREEMPT_DYNAMIC", "linux-image-rt");
  write("sys/devices/system/cpu/isolated", "3\n");
  expect_warning("isolated cores", "3", "isolcpus=2,3");
  write("sys/devices/system/cpu/nohz_full", "(null)\n");
  expect_warning("tickless cores", "none", "nohz_full=2,3");
  write("proc/cmdline", "quiet rcu_nocbs=1\n");
  expect_warning("cores without RCU callbacks", "1", "rcu_nocbs=2,3");
  write("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave\n");
  expect_warning("frequency governor", "powersave", "cpupower");
  write("sys/devices/system/cpu/cpu0/cpuidle/state1/disable", "0\n");
  expect_warning("idle states", "100 us", "cpu_dma_latency");
  write("sys/devices/system/cpu/smt/active", "1\n");
  expect_warning("hyper-threads", "on", "nosmt");
  write("sys/kernel/mm/transparent_hugepage/enabled", "[always] madvise never\n");
  expect_warning("huge pages", "always", "madvise");
  write("proc/sys/net/core/rmem_max", "212992\n");
  expect_warning("receive buffer", "212992", "net.core.rmem_max=4194304");
  write("proc/sys/kernel/sched_rt_runtime_us", "500000\n");
  expect_warning("real-time share", "500 of 1000", "sched_rt_runtime_us");
  write("proc/swaps", "Filename Type Size Used Priority\n/dev/sda2 partition 1 0 -2\n");
  expect_warning("swap", "on", "swapoff");
  write("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet\n");
  expect_warning("clock source", "hpet", "clocksource=tsc");
  write("sys/class/net/can0/flags", "0x40080\n");
  expect_warning("CAN interface", "can0 is down", "ip link set can0 up");
  write("sys/class/net/can0/tx_queue_len", "10\n");
  expect_warning("CAN queue", "10 frames", "txqueuelen");
  write("proc/irq/40/smp_affinity_list", "0-3\n");
  expect_warning("interrupts", "0,1,2,3", "smp_affinity_list");
}

TEST_F(HostChecksTest, CoresMatterOnlyWhereThreadsAreBoundToThem) {
  needs_.cores.clear();
  EXPECT_EQ(check()["isolated cores"].verdict, Verdict::pass);
}

TEST(HostFiles, ListsOfCores) {
  EXPECT_THAT(parse_cores("0-2,5"), ElementsAre(0, 1, 2, 5));
  EXPECT_THAT(parse_cores(""), IsEmpty());
  EXPECT_THAT(parse_cores("x,3-,-,7,9-8"), ElementsAre(7));
  EXPECT_LT(parse_cores("0-2147483647").size(), 5000U);
}

TEST(QueueingDiscipline, OfTheLoopback) {
  const std::optional<std::string> found = queueing_discipline("lo");
  if (!found) GTEST_SKIP() << "no loopback, or no netlink here";
  EXPECT_THAT(*found, testing::MatchesRegex("[a-z_]+"));
  EXPECT_FALSE(queueing_discipline("nosuch0"));
}

TEST(DoctorCommand, RunsOnThisHostWhateverItIs) {
  const test::Outcome outcome = test::run_landfix({"doctor"});
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_THAT(outcome.out, HasSubstr("kernel"));
  EXPECT_THAT(outcome.out, HasSubstr("thread rx"));
}

TEST(DoctorCommand, SaysItAsJsonToo) {
  const test::TemporaryDirectory nothing;
  std::ofstream(nothing.path() / "a.toml")
      << "[sensor]\nmodel = \"vlp16\"\n[realtime]\nsolve_core = 0\n[can]\ninterface = \"can7\"\n";
  const test::Outcome outcome =
      test::run_landfix({"doctor", "--json", "--root", nothing.path().string(), "--config",
                         (nothing.path() / "a.toml").string(), "--interface", "eth7"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_GT(json["checks"].size(), 15U);
  EXPECT_THAT(outcome.out, HasSubstr("no can7 here"));
  EXPECT_THAT(outcome.out, HasSubstr("isolcpus=0"));
}

TEST(DoctorCommand, RefusesAConfigurationThatDoesNotDo) {
  EXPECT_EQ(test::run_landfix({"doctor", "--config", "/nonexistent.toml"}).code, 1);
}

}  // namespace
}  // namespace landfix::tools
