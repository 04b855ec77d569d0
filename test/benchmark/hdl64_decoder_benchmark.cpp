// The HDL-64E in its generations.
#include <cstdint>

#include "benchmark/decode_recording.hpp"
#include "support/hdl64_packets.hpp"

namespace {

namespace drivers = landfix::drivers;
using drivers::velodyne::Hdl64Calibration;
using landfix::test::Recording;

constexpr std::int64_t kHourUtcNs = 1'700'002'800'000'000'000;
constexpr unsigned kMostRaw = 15'000;  // 30 m, so that the two-point correction is for some of them

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

struct Kind {
  const char* model;
  std::size_t returns;
  std::size_t blocks;  ///< a firing
  double firing_us;
};

/// One second at 600 rpm.
Recording record(const Kind& kind) {
  Recording recording{.records_a_packet = 384};
  const std::size_t firings = 12 / kind.blocks;
  for (double time_us = 0.0; time_us < 1e6; time_us += kind.firing_us * static_cast<double>(firings)) {
    const auto azimuth = static_cast<unsigned>(time_us * 0.36) % 36000;
    const auto step = static_cast<unsigned>(kind.firing_us * 0.36);
    auto packet = kind.blocks == 1 ? landfix::test::hdl64s1_packet(azimuth, step)
                                   : landfix::test::hdl64_packet(azimuth, step, kind.returns);
    if (kind.blocks != 1) packet.set_time_us(static_cast<std::uint32_t>(time_us));
    for (std::size_t block = 0; block < 12; ++block) {
      const bool is_second = kind.returns == 2 && block / 2 % 2 == 1;
      const std::size_t firing = recording.packets.size() + block / kind.blocks;
      for (std::size_t slot = 0; slot < 32; ++slot) {
        packet.set_return(block, slot, landfix::test::range_raw(slot, firing, is_second, kMostRaw), 60);
      }
    }
    recording.add(packet.bytes(), kHourUtcNs + static_cast<std::int64_t>(time_us * 1e3));
  }
  return recording;
}

void decode(benchmark::State& state, const Kind& kind) {
  const drivers::SensorModel& model = *drivers::find_sensor_model(kind.model);
  landfix::test::decode_recording(state, model, drivers::make_decoder(model, {}, calibration()),
                                  record(kind));
}

BENCHMARK_CAPTURE(decode, hdl64s2, Kind{"hdl64s2", 1, 2, 48.0});
BENCHMARK_CAPTURE(decode, hdl64s3, Kind{"hdl64s3", 1, 2, 48.0});
BENCHMARK_CAPTURE(decode, hdl64s3_dual, Kind{"hdl64s3", 2, 4, 57.6});
BENCHMARK_CAPTURE(decode, hdl64s1, Kind{"hdl64s1", 1, 1, 32.0});

}  // namespace
