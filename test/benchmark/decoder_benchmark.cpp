// Return records a second, empty ones included, from packets in memory to points in a sweep.
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "drivers/make_decoder.hpp"
#include "support/synthetic_packets.hpp"

namespace {

using landfix::drivers::AnyDecoder;
using landfix::drivers::Point;
using landfix::drivers::SensorModel;
using landfix::drivers::SweepPair;

constexpr std::int64_t kHourUtcNs = 1'700'002'800'000'000'000;

struct Recording {
  std::vector<std::vector<std::byte>> packets;
  std::vector<std::int64_t> receive_utc_ns;
  std::size_t records_a_packet = 0;
};

/// Half of the second returns are equal to the first, one record in ten is empty.
unsigned range_raw(std::size_t slot, std::size_t firing, std::size_t second) {
  if ((slot + firing) % 10 == 0) return 0;
  const unsigned first = 1000 + static_cast<unsigned>(slot * 37 + firing * 11) % 4000;
  return second == 1 && slot % 2 == 0 ? first / 2 : first;
}

/// One second of a VLP-16 at 600 rpm.
Recording vlp16(std::size_t returns) {
  Recording recording{.packets = {}, .receive_utc_ns = {}, .records_a_packet = 12 * 32};
  const auto count = returns == 2 ? 1507U : 753U;
  const std::size_t firings = 12 / returns;
  for (unsigned i = 0; i < count; ++i) {
    landfix::test::VelodynePacket packet(0x22, returns == 2 ? 0x39 : 0x37);
    const double time_us = i * static_cast<double>(firings) * 110.592;
    packet.set_azimuths(static_cast<unsigned>(time_us * 0.36) % 36000, 40, returns);
    packet.set_time_us(static_cast<std::uint32_t>(time_us));
    for (std::size_t block = 0; block < 12; ++block) {
      for (std::size_t slot = 0; slot < 32; ++slot) {
        packet.set_return(block, slot, range_raw(slot, i * firings + block / returns, block % returns), 10);
      }
    }
    recording.packets.emplace_back(packet.bytes().begin(), packet.bytes().end());
    recording.receive_utc_ns.push_back(kHourUtcNs + static_cast<std::int64_t>(time_us * 1e3));
  }
  return recording;
}

/// One second of a Pandar at 600 rpm: `make` writes the packet of a number.
template <class Make>
Recording pandar(std::size_t returns, Make make) {
  const landfix::test::PandarPacket shape = make(0);
  const std::size_t firings = shape.blocks() / returns;
  Recording recording{
      .packets = {}, .receive_utc_ns = {}, .records_a_packet = shape.blocks() * shape.lasers()};
  for (unsigned i = 0; i * firings < 18000; ++i) {
    landfix::test::PandarPacket packet = make(i);
    const double time_us = i * static_cast<double>(firings) * 55.56;
    packet.set_mode(returns == 2 ? 0x39 : 0x37);
    packet.set_azimuths(static_cast<unsigned>(time_us * 0.36) % 36000, 20, returns);
    packet.set_microseconds(static_cast<std::uint32_t>(time_us) % 1'000'000);
    for (std::size_t block = 0; block < packet.blocks(); ++block) {
      for (std::size_t slot = 0; slot < packet.lasers(); ++slot) {
        packet.set_return(block, slot, range_raw(slot, i * firings + block / returns, block % returns), 10);
      }
    }
    recording.packets.emplace_back(packet.bytes().begin(), packet.bytes().end());
    recording.receive_utc_ns.push_back(landfix::test::PandarPacket::kDateUtcNs +
                                       static_cast<std::int64_t>(time_us * 1e3));
  }
  return recording;
}

void decode(benchmark::State& state, const char* model_name, const Recording& recording) {
  const SensorModel& model = *landfix::drivers::find_sensor_model(model_name);
  const AnyDecoder made = landfix::drivers::make_decoder(model, {});
  std::vector<Point> storage(2 * model.max_points_per_sweep());
  for (auto _ : state) {
    // One that has seen a recording would not take it a second time.
    AnyDecoder decoder = made;
    SweepPair sweeps(storage);
    for (std::size_t i = 0; i < recording.packets.size(); ++i) {
      const auto result = decoder.decode(
          {.payload = recording.packets[i], .receive_utc_ns = recording.receive_utc_ns[i]}, sweeps);
      if (result.status != landfix::drivers::DecodeStatus::decoded) {
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

void decode_vlp16(benchmark::State& state) {
  decode(state, "vlp16", vlp16(static_cast<std::size_t>(state.range(0))));
}
void decode_pandar64(benchmark::State& state) {
  decode(state, "pandar64", pandar(static_cast<std::size_t>(state.range(0)), [](unsigned number) {
           return landfix::test::Pandar64Packet(0x37, 6, number);
         }));
}
void decode_pandar40p(benchmark::State& state) {
  decode(state, "pandar40p", pandar(static_cast<std::size_t>(state.range(0)), [](unsigned /*number*/) {
           return landfix::test::Pandar40pPacket();
         }));
}

BENCHMARK(decode_vlp16)->ArgName("returns")->Arg(1)->Arg(2);
BENCHMARK(decode_pandar64)->ArgName("returns")->Arg(1)->Arg(2);
BENCHMARK(decode_pandar40p)->ArgName("returns")->Arg(1)->Arg(2);

}  // namespace
