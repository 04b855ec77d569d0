// Return records a second of the HDL-64E, empty ones included, from packets in memory to points in a sweep.
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "drivers/make_decoder.hpp"
#include "support/hdl64_packets.hpp"

namespace {

namespace drivers = landfix::drivers;
using drivers::velodyne::Hdl64Calibration;

constexpr std::int64_t kHourUtcNs = 1'700'002'800'000'000'000;
constexpr std::size_t kRecordsPerPacket = 384;

/// Every correction has something to do.
Hdl64Calibration calibration() {
  Hdl64Calibration unit;
  for (std::size_t i = 0; i < unit.lasers.size(); ++i) {
    const auto place = static_cast<double>(i);
    unit.lasers[i] = {.rotation_deg = -6.0 + 0.2 * place,
                      .elevation_deg = -24.0 + 0.4 * place,
                      .range_m = 1.25 + 0.001 * place,
                      .range_x_m = 1.30,
                      .range_y_m = 1.28,
                      .vertical_offset_m = 0.2,
                      .horizontal_offset_m = i % 2 == 0 ? 0.026 : -0.026,
                      .focal_distance_m = 10.0,
                      .focal_slope = 1.2,
                      .min_intensity = 10,
                      .max_intensity = 250};
  }
  return unit;
}

/// One record in ten is empty; half of the second returns are equal to the first.
unsigned range_raw(std::size_t slot, std::size_t firing, std::size_t second) {
  if ((slot + firing) % 10 == 0) return 0;
  const unsigned first = 1000 + static_cast<unsigned>(slot * 37 + firing * 11) % 14000;
  return second == 1 && slot % 2 == 0 ? first / 2 : first;
}

struct Kind {
  const char* model;
  std::size_t returns;
  std::size_t blocks;  ///< a firing
  double firing_us;
};

/// One second at 600 rpm.
std::vector<std::vector<std::byte>> packets_of(const Kind& kind) {
  std::vector<std::vector<std::byte>> packets;
  const std::size_t firings = 12 / kind.blocks;
  for (double time_us = 0.0; time_us < 1e6; time_us += kind.firing_us * static_cast<double>(firings)) {
    const auto azimuth = static_cast<unsigned>(time_us * 0.36) % 36000;
    const auto step = static_cast<unsigned>(kind.firing_us * 0.36);
    auto packet = kind.blocks == 1 ? landfix::test::hdl64s1_packet(azimuth, step)
                                   : landfix::test::hdl64_packet(azimuth, step, kind.returns);
    if (kind.blocks != 1) packet.set_time_us(static_cast<std::uint32_t>(time_us));
    for (std::size_t block = 0; block < 12; ++block) {
      for (std::size_t slot = 0; slot < 32; ++slot) {
        const std::size_t second = kind.returns == 2 ? block / 2 % 2 : 0;
        packet.set_return(block, slot, range_raw(slot, packets.size() + block / kind.blocks, second), 60);
      }
    }
    packets.emplace_back(packet.bytes().begin(), packet.bytes().end());
  }
  return packets;
}

void decode(benchmark::State& state, const Kind& kind) {
  const drivers::SensorModel& model = *drivers::find_sensor_model(kind.model);
  const auto packets = packets_of(kind);
  const double packet_us = kind.firing_us * static_cast<double>(12 / kind.blocks);
  drivers::AnyDecoder decoder = drivers::make_decoder(model, {}, calibration());
  std::vector<drivers::Point> storage(2 * model.max_points_per_sweep());
  drivers::SweepPair sweeps(storage);
  for (auto _ : state) {
    for (std::size_t i = 0; i < packets.size(); ++i) {
      const auto receive_utc_ns =
          kHourUtcNs + static_cast<std::int64_t>(static_cast<double>(i) * packet_us * 1e3);
      const auto result = decoder.decode({.payload = packets[i], .receive_utc_ns = receive_utc_ns}, sweeps);
      // The first of each second but the first goes back in time.
      if (result.status != drivers::DecodeStatus::decoded && i > 1) {
        state.SkipWithError("a packet was refused");
        return;
      }
    }
    benchmark::DoNotOptimize(sweeps.current().points().data());
  }
  state.counters["records"] = benchmark::Counter(static_cast<double>(packets.size() * kRecordsPerPacket),
                                                 benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK_CAPTURE(decode, hdl64s2, Kind{"hdl64s2", 1, 2, 48.0});
BENCHMARK_CAPTURE(decode, hdl64s3, Kind{"hdl64s3", 1, 2, 48.0});
BENCHMARK_CAPTURE(decode, hdl64s3_dual, Kind{"hdl64s3", 2, 4, 57.6});
BENCHMARK_CAPTURE(decode, hdl64s1, Kind{"hdl64s1", 1, 1, 32.0});

}  // namespace
