#include "platform/realtime.hpp"

#include <fstream>
#include <limits>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/heap_counter.hpp"
#include "support/child_process.hpp"

namespace landfix::platform {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

long locked_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmLck:") {
      long kib = 0;
      status >> kib;
      return kib;
    }
  }
  return -1;
}

TEST(Realtime, LocksMemory) {
  if (!HeapCounter::available()) GTEST_SKIP() << "a sanitizer, whose shadow is larger than all memory";
  const std::string said = test::in_child([] {
    const Missing missing = lock_memory();
    return missing ? "skip: " + *missing : std::to_string(locked_kib());
  });
  if (said.starts_with("skip")) GTEST_SKIP() << said;
  EXPECT_GT(std::stol(said), 1000) << said;
}

TEST(Realtime, LaterStacksAreNotLocked) {
  if (!HeapCounter::available()) GTEST_SKIP() << "a sanitizer, whose shadow is larger than all memory";
  const std::string said = test::in_child([] {
    if (const Missing missing = lock_memory()) return "skip: " + *missing;
    const long before = locked_kib();
    long with_thread = 0;
    std::thread([&] { with_thread = locked_kib(); }).join();
    return std::to_string(with_thread - before);
  });
  if (said.starts_with("skip")) GTEST_SKIP() << said;
  EXPECT_LT(std::stol(said), 4096) << said;  // of 8 MiB
}

TEST(Realtime, WithoutRightsItSaysWhatIsMissingAndHowToGiveIt) {
  if (!HeapCounter::available()) GTEST_SKIP() << "a sanitizer, which locks nothing and says that it did";
  EXPECT_THAT(test::in_child([] {
                test::give_up_rights();
                return lock_memory().value_or("locked");
              }),
              AllOf(StartsWith("memory is not locked"), HasSubstr("landfixd"), HasSubstr("setcap"),
                    HasSubstr("LimitMEMLOCK")));
  EXPECT_THAT(test::in_child([] {
                test::give_up_rights();
                return set_priority(::pthread_self(), "rx", 80).value_or("set");
              }),
              AllOf(StartsWith("thread rx has no real-time priority"), HasSubstr("SCHED_FIFO 80"),
                    HasSubstr("setcap"), HasSubstr("LimitRTPRIO")));
}

TEST(Realtime, OrdinaryPriorityAndAnyCoreNeedNoRights) {
  EXPECT_EQ(test::in_child([] {
              test::give_up_rights();
              return set_priority(::pthread_self(), "house", 0).value_or("set") +
                     set_core(::pthread_self(), "house", -1).value_or(" any");
            }),
            "set any");
}

TEST(Realtime, ACoreThatIsNotThereIsNamedWithThoseThatAre) {
  EXPECT_THAT(set_core(::pthread_self(), "rx", 1023).value_or("set"),
              AllOf(StartsWith("thread rx is not bound to core 1023"), HasSubstr("realtime.rx_core of 0")));
  EXPECT_TRUE(set_core(::pthread_self(), "rx", 100'000));
}

TEST(Realtime, FlushesDenormalsOfOneThread) {
  const auto half_of_smallest = [] {
    volatile double smallest = std::numeric_limits<double>::min();
    return smallest * 0.5;
  };
  double flushed = 1.0;
  std::thread([&] {
    flush_denormals();
    flushed = half_of_smallest();
  }).join();
#if defined(__x86_64__) || defined(__aarch64__)
  EXPECT_EQ(flushed, 0.0);
#endif
  EXPECT_GT(half_of_smallest(), 0.0);
}

}  // namespace
}  // namespace landfix::platform
