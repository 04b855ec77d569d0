// Decodes packets in memory again and again: return records a second, empty ones included, from the bytes to
// points in a sweep.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <benchmark/benchmark.h>

#include "drivers/make_decoder.hpp"

namespace landfix::test {

/// Packets of a sensor in the order of their receipt.
struct Recording {
  std::size_t records_a_packet = 0;
  std::vector<std::vector<std::byte>> packets{};
  std::vector<std::int64_t> receive_utc_ns{};

  void add(std::span<const std::byte> packet, std::int64_t utc_ns) {
    packets.emplace_back(packet.begin(), packet.end());
    receive_utc_ns.push_back(utc_ns);
  }
};

/// A range of the wire, up to `most`: one record in ten is empty, half of the second returns are equal to the
/// first.
[[nodiscard]] inline unsigned range_raw(std::size_t slot, std::size_t firing, bool is_second,
                                        unsigned most = 5000) {
  if ((slot + firing) % 10 == 0) return 0;
  const unsigned first = 1000 + static_cast<unsigned>(slot * 37 + firing * 11) % (most - 1000);
  return is_second && slot % 2 == 0 ? first / 2 : first;
}

/// `made` has all that it needs to give points.
inline void decode_recording(benchmark::State& state, const drivers::SensorModel& model,
                             const drivers::AnyDecoder& made, const Recording& recording) {
  std::vector<drivers::Point> storage(2 * model.max_points_per_sweep());
  drivers::SweepPair sweeps(storage);
  for (auto _ : state) {
    // One that has seen a recording would not take it a second time.
    drivers::AnyDecoder decoder = made;
    for (std::size_t i = 0; i < recording.packets.size(); ++i) {
      const auto result = decoder.decode(
          {.payload = recording.packets[i], .receive_utc_ns = recording.receive_utc_ns[i]}, sweeps);
      if (result.status != drivers::DecodeStatus::decoded) {
        state.SkipWithError("a packet was refused");
        return;
      }
    }
    benchmark::DoNotOptimize(sweeps.current().points().data());
  }
  const auto records = recording.packets.size() * recording.records_a_packet;
  state.counters["records"] =
      benchmark::Counter(static_cast<double>(records), benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace landfix::test
