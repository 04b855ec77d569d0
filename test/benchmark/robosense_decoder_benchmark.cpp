// Return records a second of RoboSense's sensors, empty ones included, from packets in memory to points in a
// sweep.
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "drivers/make_decoder.hpp"
#include "support/robosense_packets.hpp"

namespace {

using landfix::drivers::AnyDecoder;
using landfix::drivers::DecodeStatus;
using landfix::drivers::Point;
using landfix::drivers::SensorModel;
using landfix::drivers::SweepPair;
using landfix::test::RobosensePacket;

constexpr std::size_t kRecordsAPacket = 384;  // 12 blocks of 32

struct Recording {
  std::vector<std::vector<std::byte>> packets;
  std::vector<std::int64_t> receive_utc_ns;
};

/// Half of the second returns are equal to the first, one record in ten is empty.
unsigned range_raw(std::size_t slot, std::size_t firing, std::size_t second) {
  if ((slot + firing) % 10 == 0) return 0;
  const unsigned first = 1000 + static_cast<unsigned>(slot * 37 + firing * 11) % 4000;
  return second == 1 && slot % 2 == 0 ? first / 2 : first;
}

/// One second at 600 rpm. 32 lasers: a firing a block, or a return of it. 16: two firings, or two returns.
Recording record(const char* model, std::size_t lasers, double period_us, std::size_t returns) {
  Recording recording;
  const std::size_t blocks_a_firing = lasers == 32 ? returns : 1;
  const double block_us = period_us * (lasers == 16 && returns == 1 ? 2.0 : 1.0);
  const double packet_us = block_us * 12.0 / static_cast<double>(blocks_a_firing);
  for (unsigned i = 0; i * packet_us < 1e6; ++i) {
    RobosensePacket packet(model);
    const double time_us = i * packet_us;
    packet.set_azimuths(static_cast<unsigned>(time_us * 0.36) % 36000, block_us * 0.36, blocks_a_firing);
    packet.set_time_us(static_cast<std::int64_t>(time_us));
    for (std::size_t block = 0; block < 12; ++block) {
      for (std::size_t slot = 0; slot < 32; ++slot) {
        const bool second = returns == 2 && (lasers == 32 ? block % 2 == 1 : slot >= 16);
        const std::size_t firing = std::size_t{i} * 12 + (lasers == 32 ? block / blocks_a_firing : block);
        packet.set_return(block, slot, range_raw(slot % lasers, firing, second ? 1 : 0), 10);
      }
    }
    recording.packets.emplace_back(packet.bytes().begin(), packet.bytes().end());
    recording.receive_utc_ns.push_back(RobosensePacket::kTimeUtcNs +
                                       static_cast<std::int64_t>(time_us * 1e3));
  }
  return recording;
}

void decode(benchmark::State& state, const char* name, double period_us) {
  const auto returns = static_cast<std::size_t>(state.range(0));
  const SensorModel& model = *landfix::drivers::find_sensor_model(name);
  const Recording recording = record(name, model.beam_count, period_us, returns);
  auto unit = landfix::test::robosense_unit(name);
  if (returns == 2) unit.set_return_mode(0);
  std::vector<Point> storage(2 * model.max_points_per_sweep());
  SweepPair sweeps(storage);
  for (auto _ : state) {
    // A decoder for each second: the same second once more would be packets that have come before.
    AnyDecoder decoder = landfix::drivers::make_decoder(model, {});
    static_cast<void>(
        decoder.decode({.payload = unit.bytes(), .receive_utc_ns = RobosensePacket::kTimeUtcNs}, sweeps));
    for (std::size_t i = 0; i < recording.packets.size(); ++i) {
      const auto result = decoder.decode(
          {.payload = recording.packets[i], .receive_utc_ns = recording.receive_utc_ns[i]}, sweeps);
      if (result.status != DecodeStatus::decoded) {
        state.SkipWithError("a packet was refused");
        return;
      }
    }
    benchmark::DoNotOptimize(sweeps.current().points().data());
  }
  const auto records = recording.packets.size() * kRecordsAPacket;
  state.counters["records"] =
      benchmark::Counter(static_cast<double>(records), benchmark::Counter::kIsIterationInvariantRate);
}

void decode_rs32(benchmark::State& state) { decode(state, "rs32", 55.52); }
void decode_rs16(benchmark::State& state) { decode(state, "rs16", 55.5); }
void decode_helios16p(benchmark::State& state) { decode(state, "helios16p", 55.56); }

BENCHMARK(decode_rs32)->ArgName("returns")->Arg(1)->Arg(2);
BENCHMARK(decode_rs16)->ArgName("returns")->Arg(1)->Arg(2);
BENCHMARK(decode_helios16p)->ArgName("returns")->Arg(1)->Arg(2);

}  // namespace
