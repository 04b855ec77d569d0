// What it costs to hand a Velodyne's packet, 1,206 bytes, to another thread. The queue beside the ring, where
// it is installed (libreaderwriterqueue-dev), is lock-free too, and copies each packet in and out.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <thread>

#include <benchmark/benchmark.h>

#include "platform/packet_ring.hpp"

#if __has_include(<readerwriterqueue/readerwriterqueue.h>)
#include <readerwriterqueue/readerwriterqueue.h>
#define LANDFIX_READERWRITERQUEUE
#endif

namespace {

constexpr std::size_t kPacket_bytes = 1206;
constexpr std::size_t kSlots = 1024;
using Packet = std::array<std::byte, kPacket_bytes>;

class Ring {
 public:
  bool push(const Packet& packet) {
    if (ring_.free_slots(1) == 0) return false;
    std::ranges::copy(packet, ring_.room(0).begin());
    ring_.header_to_fill(0).size = kPacket_bytes;
    ring_.publish(1);
    return true;
  }
  /// Looks at both ends of the packet where it lies, as a decoder does.
  bool pop(unsigned& sum) {
    if (ring_.waiting(1) == 0) return false;
    const auto payload = ring_.front().payload;
    sum += std::to_integer<unsigned>(payload.front()) + std::to_integer<unsigned>(payload.back());
    ring_.free();
    return true;
  }

 private:
  landfix::platform::PacketRing ring_{kPacket_bytes, kSlots};
};

#ifdef LANDFIX_READERWRITERQUEUE
class ReaderWriterQueue {
 public:
  bool push(const Packet& packet) { return queue_.try_enqueue(packet); }
  bool pop(unsigned& sum) {
    if (!queue_.try_dequeue(taken_)) return false;
    sum += std::to_integer<unsigned>(taken_.front()) + std::to_integer<unsigned>(taken_.back());
    return true;
  }

 private:
  moodycamel::ReaderWriterQueue<Packet> queue_{kSlots};
  Packet taken_{};
};
#endif

void count(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations());
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(kPacket_bytes));
}

/// In and out again in one thread: the work, without another core's cache.
template <class Queue>
void push_and_pop(benchmark::State& state) {
  Queue queue;
  const Packet packet{};
  unsigned sum = 0;
  for ([[maybe_unused]] auto _ : state) {
    if (!queue.push(packet) || !queue.pop(sum)) state.SkipWithError("a packet was lost");
  }
  benchmark::DoNotOptimize(sum);
  count(state);
}

/// From a thread that pushes as fast as there is room.
template <class Queue>
void across_threads(benchmark::State& state) {
  Queue queue;
  std::atomic<bool> is_over = false;
  std::thread producer([&] {
    const Packet packet{};
    while (!is_over.load(std::memory_order_relaxed)) static_cast<void>(queue.push(packet));
  });
  unsigned sum = 0;
  for ([[maybe_unused]] auto _ : state) {
    while (!queue.pop(sum)) {
    }
  }
  is_over.store(true, std::memory_order_relaxed);
  producer.join();
  benchmark::DoNotOptimize(sum);
  count(state);
}

BENCHMARK(push_and_pop<Ring>)->Name("push_and_pop/ring");
BENCHMARK(across_threads<Ring>)->Name("across_threads/ring")->UseRealTime();
#ifdef LANDFIX_READERWRITERQUEUE
BENCHMARK(push_and_pop<ReaderWriterQueue>)->Name("push_and_pop/readerwriterqueue");
BENCHMARK(across_threads<ReaderWriterQueue>)->Name("across_threads/readerwriterqueue")->UseRealTime();
#endif

}  // namespace
