// Return records a second, empty ones included, from packets in memory to points in a sweep; and the
// checksum alone, in bytes a second.
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "drivers/make_decoder.hpp"
#include "drivers/ouster/crc64.hpp"
#include "support/ouster_packets.hpp"

namespace {

using landfix::drivers::Point;
using landfix::drivers::ouster::Profile;

constexpr std::int64_t kStartUtcNs = 1'700'002'800'000'000'000;
constexpr std::int64_t kPacketNs = 1'562'500;

/// Half of the second returns are equal to the first, one record in ten is empty, at no regular places.
std::vector<std::vector<std::byte>> turns(const landfix::drivers::ouster::Metadata& metadata,
                                          std::size_t turns, bool checked) {
  const auto& pixel = landfix::drivers::ouster::pixel_of(metadata.profile);
  std::vector<std::vector<std::byte>> packets;
  std::uint32_t random = 1;
  for (std::size_t i = 0; i < 64 * turns; ++i) {
    landfix::test::OusterPacket packet(metadata);
    packet.set_frame(static_cast<std::uint32_t>(i / 64));
    packet.set_place(i % 64, kStartUtcNs + static_cast<std::int64_t>(i) * kPacketNs);
    for (std::size_t column = 0; column < 16; ++column) {
      for (std::size_t row = 0; row < metadata.row_count; ++row) {
        random = random * 1'664'525 + 1'013'904'223;
        if ((random >> 16) % 10 == 0) continue;
        const unsigned range = 1000 + (random >> 8) % 20'000;
        packet.set_return(column, row, range, 10);
        if (pixel.returns() == 2) {
          packet.set_return(column, row, row % 2 == 0 ? range / 2 : range, 10, 1);
        }
      }
    }
    if (checked) packet.set_crc();
    packets.emplace_back(packet.bytes().begin(), packet.bytes().end());
  }
  return packets;
}

void decode(benchmark::State& state, const char* model_name, Profile profile, bool checked) {
  const auto& model = *landfix::drivers::find_sensor_model(model_name);
  const auto metadata = landfix::test::ouster_metadata(profile, model.beam_count);
  const auto packets = turns(metadata, 4, checked);
  const auto returns = landfix::drivers::ouster::pixel_of(profile).returns();
  auto decoder = landfix::drivers::make_decoder(model, {}, metadata);
  std::vector<Point> storage(2 * model.max_points_per_sweep());
  landfix::drivers::SweepPair sweeps(storage);
  for (auto _ : state) {
    // The packets come again: their decoder must not know them, at the price of its small tables.
    state.PauseTiming();
    decoder = landfix::drivers::make_decoder(model, {}, metadata);
    state.ResumeTiming();
    for (std::size_t i = 0; i < packets.size(); ++i) {
      const auto result = decoder.decode(
          {.payload = packets[i], .receive_utc_ns = kStartUtcNs + static_cast<std::int64_t>(i) * kPacketNs},
          sweeps);
      if (result.status != landfix::drivers::DecodeStatus::decoded) {
        state.SkipWithError("a packet was refused");
        return;
      }
    }
    benchmark::DoNotOptimize(sweeps.current().points().data());
  }
  const auto records = packets.size() * 16 * metadata.row_count * returns;
  state.counters["records"] =
      benchmark::Counter(static_cast<double>(records), benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK_CAPTURE(decode, os1_16_legacy, "os1-16", Profile::legacy, false);
BENCHMARK_CAPTURE(decode, os1_64_legacy, "os1-64", Profile::legacy, false);
BENCHMARK_CAPTURE(decode, os1_64_single, "os1-64", Profile::single, false);
BENCHMARK_CAPTURE(decode, os1_64_single_with_checksum, "os1-64", Profile::single, true);
BENCHMARK_CAPTURE(decode, os1_64_dual, "os1-64", Profile::dual, false);
BENCHMARK_CAPTURE(decode, os1_64_dual_with_checksum, "os1-64", Profile::dual, true);
BENCHMARK_CAPTURE(decode, os0_32_single, "os0-32", Profile::single, false);
BENCHMARK_CAPTURE(decode, os1_128_low_rate, "os1-128", Profile::low_rate, false);
BENCHMARK_CAPTURE(decode, os1_128_low_rate_with_checksum, "os1-128", Profile::low_rate, true);
BENCHMARK_CAPTURE(decode, os2_128_low_rate_dual, "os2-128", Profile::low_rate_dual_fusa, false);
BENCHMARK_CAPTURE(decode, os2_128_dual, "os2-128", Profile::dual, false);

void checksum(benchmark::State& state, std::uint64_t (*crc)(std::span<const std::byte>) noexcept) {
  std::vector<std::byte> packet(12544, std::byte{0x5A});
  for (auto _ : state) benchmark::DoNotOptimize(crc(packet));
  state.SetBytesProcessed(static_cast<std::int64_t>(packet.size()) * state.iterations());
}

BENCHMARK_CAPTURE(checksum, folding, landfix::drivers::ouster::crc64);
BENCHMARK_CAPTURE(checksum, tables, landfix::drivers::ouster::crc64_by_tables);

}  // namespace
