#include "platform/heap_counter.hpp"

#include <cstdlib>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "platform/candump_log.hpp"
#include "platform/latency_histogram.hpp"
#include "platform/page_faults.hpp"
#include "platform/pcap_source.hpp"
#include "platform/pcap_writer.hpp"
#include "platform/pose_frame_decoder.hpp"
#include "platform/pose_frames.hpp"
#include "support/frames.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

using test::payload;

void* volatile escaped;

/// Keeps the optimiser from removing an allocation that nobody uses.
void* escape(void* memory) {
  escaped = memory;
  return memory;
}

template <class Work>
std::uint64_t calls_of(Work work) {
  const std::uint64_t before = HeapCounter::calls();
  HeapCounter::arm();
  work();
  HeapCounter::disarm();
  return HeapCounter::calls() - before;
}

class HeapCounterTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!HeapCounter::available()) GTEST_SKIP() << "the heap cannot be counted: a sanitizer, or not glibc";
  }
};

TEST_F(HeapCounterTest, FindsTheLockOfAMutex) {
  std::mutex mutex;
  const std::uint64_t before = HeapCounter::locks();
  HeapCounter::arm();
  { const std::scoped_lock lock(mutex); }
  HeapCounter::disarm();
  { const std::scoped_lock lock(mutex); }
  EXPECT_EQ(HeapCounter::locks() - before, 1U);
}

TEST_F(HeapCounterTest, FindsEveryWayToTheHeap) {
  EXPECT_EQ(calls_of([] { escaped = std::malloc(10); }), 1U);
  EXPECT_EQ(calls_of([] { escaped = std::realloc(escaped, 1000); }), 1U);
  EXPECT_EQ(calls_of([] { std::free(escaped); }), 1U);
  EXPECT_EQ(calls_of([] { std::free(nullptr); }), 0U);
  EXPECT_EQ(calls_of([] { std::free(escape(std::calloc(2, 3))); }), 2U);
  EXPECT_EQ(calls_of([] { std::free(escape(std::aligned_alloc(64, 128))); }), 2U);
  EXPECT_EQ(calls_of([] {
              void* memory = nullptr;
              EXPECT_EQ(::posix_memalign(&memory, 64, 100), 0);
              escaped = memory;
              std::free(memory);
            }),
            2U);
  EXPECT_EQ(calls_of([] {
              const auto number = std::make_unique<int>(1);
              escaped = number.get();
            }),
            2U);
  EXPECT_EQ(calls_of([] { escaped = std::vector<int>(1000).data(); }), 2U);
}

TEST_F(HeapCounterTest, CountsNothingUnlessArmed) {
  const std::uint64_t before = HeapCounter::calls();
  std::free(escape(std::malloc(10)));
  EXPECT_EQ(HeapCounter::calls(), before);
}

TEST_F(HeapCounterTest, CountsTheCallingThreadAlone) {
  EXPECT_EQ(calls_of([] {}), 0U);
  HeapCounter::arm();
  const std::uint64_t before = HeapCounter::calls();
  std::thread other([] {
    std::free(escape(std::malloc(10)));
    EXPECT_EQ(HeapCounter::calls(), 0U);
  });
  const std::uint64_t of_starting_it = HeapCounter::calls() - before;
  HeapCounter::disarm();
  other.join();
  EXPECT_LE(of_starting_it, 4U);
}

TEST_F(HeapCounterTest, ReadingACaptureDoesNotTouchTheHeap) {
  const test::TemporaryDirectory directory;
  PcapWriter writer(directory.path() / "a.pcap");
  for (unsigned i = 0; i < 300; ++i) writer.write({}, payload(i % 3 == 0 ? 12608 : 1206, i), i);
  writer.commit();
  PcapSource source(directory.path() / "a.pcap");
  UdpPacket packet;
  int packets = 0;
  EXPECT_EQ(calls_of([&] {
              while (source.next(packet) == ReadStatus::packet) ++packets;
            }),
            0U);
  EXPECT_EQ(packets, 300);
}

TEST_F(HeapCounterTest, SendingAPoseIntoALogDoesNotTouchTheHeap) {
  const test::TemporaryDirectory directory;
  CandumpLog log(directory.path() / "can.log", "can0");
  PoseFrameEncoder encoder(0x3A0, false);
  PoseFrameEncoder fd_encoder(0x3A0, true);
  PoseFrameDecoder decoder(0x3A0);
  LatencyHistogram latency;
  EXPECT_EQ(calls_of([&] {
              for (int i = 0; i < 5000; ++i) {
                const PoseReport report = report_of({}, drivers::TimeSource::sensor, true);
                const PoseFrames fd_frames = fd_encoder.encode(report);
                EXPECT_EQ(log.send(fd_frames.all(), 0), fd_frames.count);
                const PoseFrames frames = encoder.encode(report);
                for (const CanFrame& frame : frames.all()) (void)decoder.decode(frame, 0);
                EXPECT_EQ(log.send(frames.all(), 1'700'000'000'000'000'000 + i), frames.count);
                latency.record(i);
              }
            }),
            0U);
  log.commit();
}

TEST(PageFaults, TouchingFreshMemoryFaults) {
  constexpr std::size_t kBytes = 16 << 20;
  const std::unique_ptr<char[]> memory(new char[kBytes]);
  const PageFaults before = thread_page_faults();
  for (std::size_t i = 0; i < kBytes; i += 4096) memory[i] = 1;
  escaped = memory.get();
  EXPECT_GT(thread_page_faults().minor + thread_page_faults().major, before.minor + before.major);
}

}  // namespace
}  // namespace landfix::platform
