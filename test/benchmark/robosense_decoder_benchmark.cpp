// RoboSense's sensors.
#include <cstdint>
#include <span>

#include "benchmark/decode_recording.hpp"
#include "support/robosense_packets.hpp"

namespace {

using landfix::drivers::AnyDecoder;
using landfix::drivers::Point;
using landfix::drivers::SensorModel;
using landfix::drivers::SweepPair;
using landfix::test::range_raw;
using landfix::test::Recording;
using landfix::test::RobosensePacket;

/// One second at 600 rpm. 32 lasers: a firing a block, or a return of it. 16: two firings, or two returns.
Recording record(const char* model, std::size_t lasers, double period_us, std::size_t returns) {
  Recording recording{.records_a_packet = 384};
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
        packet.set_return(block, slot, range_raw(slot % lasers, firing, second), 10);
      }
    }
    recording.add(packet.bytes(), RobosensePacket::kTimeUtcNs + static_cast<std::int64_t>(time_us * 1e3));
  }
  return recording;
}

void decode(benchmark::State& state, const char* name, double period_us) {
  const auto returns = static_cast<std::size_t>(state.range(0));
  const SensorModel& model = *landfix::drivers::find_sensor_model(name);
  const Recording recording = record(name, model.beam_count, period_us, returns);
  auto unit = landfix::test::robosense_unit(name);
  if (returns == 2) unit.set_return_mode(0);
  AnyDecoder decoder = landfix::drivers::make_decoder(model, {});
  SweepPair none(std::span<Point>{});
  static_cast<void>(
      decoder.decode({.payload = unit.bytes(), .receive_utc_ns = RobosensePacket::kTimeUtcNs}, none));
  landfix::test::decode_recording(state, model, decoder, recording);
}

void decode_rs32(benchmark::State& state) { decode(state, "rs32", 55.52); }
void decode_rs16(benchmark::State& state) { decode(state, "rs16", 55.5); }
void decode_helios16p(benchmark::State& state) { decode(state, "helios16p", 55.56); }

BENCHMARK(decode_rs32)->ArgName("returns")->Arg(1)->Arg(2);
BENCHMARK(decode_rs16)->ArgName("returns")->Arg(1)->Arg(2);
BENCHMARK(decode_helios16p)->ArgName("returns")->Arg(1)->Arg(2);

}  // namespace
