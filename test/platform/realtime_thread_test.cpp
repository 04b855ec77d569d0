#include "platform/realtime_thread.hpp"

#include <csignal>
#include <cstdint>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include "platform/heap_counter.hpp"
#include "platform/page_faults.hpp"
#include "support/child_process.hpp"

namespace landfix::platform {
namespace {

using testing::HasSubstr;

/// Page faults of the calling thread while it uses 200 KiB of its stack.
[[gnu::noinline]] std::int64_t faults_of_a_deep_stack() {
  const PageFaults before = thread_page_faults();
  volatile char deep[200 * 1024];
  for (std::size_t i = 0; i < sizeof deep; i += 1024) deep[i] = 1;
  const PageFaults after = thread_page_faults();
  return after.minor + after.major - before.minor - before.major;
}

struct StackBounds {
  const std::byte* begin = nullptr;
  std::size_t bytes = 0;
};

StackBounds own_stack() {
  pthread_attr_t attributes;
  void* begin = nullptr;
  StackBounds bounds;
  ::pthread_getattr_np(::pthread_self(), &attributes);
  ::pthread_attr_getstack(&attributes, &begin, &bounds.bytes);
  ::pthread_attr_destroy(&attributes);
  bounds.begin = static_cast<const std::byte*>(begin);
  return bounds;
}

TEST(RealtimeThread, RunsUnderItsNameAndIsWaitedFor) {
  char name[16] = "";
  {
    const RealtimeThread thread(
        {.name = "rx"}, [&]() noexcept { ::pthread_getname_np(::pthread_self(), name, sizeof name); });
  }
  EXPECT_STREQ(name, "rx");
}

TEST(RealtimeThread, ItsStackIsAllThereBeforeItBegins) {
  if (!HeapCounter::available()) GTEST_SKIP() << "a sanitizer, whose shadow faults";
  (void)faults_of_a_deep_stack();  // the code itself is there
  std::int64_t faults = -1;
  {
    const RealtimeThread thread({.name = "solve"}, [&]() noexcept { faults = faults_of_a_deep_stack(); });
  }
  EXPECT_EQ(faults, 0);
  // An ordinary thread's is not.
  std::thread([&] { faults = faults_of_a_deep_stack(); }).join();
  EXPECT_GT(faults, 0);
}

TEST(RealtimeThread, HasTheStackThatWasAskedFor) {
  StackBounds bounds;
  std::size_t told = 0;
  {
    const RealtimeThread thread({.name = "tx", .stack_bytes = 100'000},
                                [&]() noexcept { bounds = own_stack(); });
    told = thread.stack_bytes();
  }
  EXPECT_EQ(told, 102'400U);
  EXPECT_EQ(bounds.bytes, told);
  EXPECT_THROW(RealtimeThread({.name = "tx", .stack_bytes = 4096}, []() noexcept {}), std::runtime_error);
}

TEST(RealtimeThreadDeathTest, AnOverflowMeetsTheGuardPage) {
  if (!HeapCounter::available()) GTEST_SKIP() << "a sanitizer reports it in its own way";
  EXPECT_EXIT(RealtimeThread({.name = "tx"},
                             []() noexcept {
                               auto* below = const_cast<std::byte*>(own_stack().begin - 1);  // NOLINT
                               *static_cast<volatile std::byte*>(below) = std::byte{1};
                             }),
              testing::KilledBySignal(SIGSEGV), "");
}

TEST(RealtimeThread, IsScheduledAsAskedBeforeItBegins) {
  int policy = -1;
  sched_param parameter{};
  cpu_set_t cores{};
  const int core = ::sched_getcpu();
  std::vector<std::string> missing;
  {
    const RealtimeThread thread({.name = "rx", .schedule = {.priority = 10, .core = core}}, [&]() noexcept {
      ::pthread_getschedparam(::pthread_self(), &policy, &parameter);
      ::pthread_getaffinity_np(::pthread_self(), sizeof cores, &cores);
    });
    missing = thread.missing();
  }
  if (!missing.empty()) GTEST_SKIP() << missing.front();
  EXPECT_EQ(policy, SCHED_FIFO);
  EXPECT_EQ(parameter.sched_priority, 10);
  EXPECT_EQ(CPU_COUNT(&cores), 1);
  EXPECT_TRUE(CPU_ISSET(static_cast<std::size_t>(core), &cores));
}

TEST(RealtimeThread, WithoutRightsItRunsAllTheSame) {
  const std::string said = test::in_child([] {
    test::give_up_rights();
    bool ran = false;
    std::vector<std::string> missing;
    {
      const RealtimeThread thread({.name = "rx", .schedule = {.priority = 80, .core = 1023}},
                                  [&]() noexcept { ran = true; });
      missing = thread.missing();
    }
    std::string text = ran ? "ran" : "did not run";
    for (const std::string& sentence : missing) text += "\n" + sentence;
    return text;
  });
  EXPECT_THAT(said, testing::StartsWith("ran\nthread rx has no real-time priority"));
  EXPECT_THAT(said, HasSubstr("\nthread rx is not bound to core 1023"));
}

}  // namespace
}  // namespace landfix::platform
