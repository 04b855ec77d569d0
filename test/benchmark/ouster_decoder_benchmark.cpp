// Ouster's sensors and profiles; and the checksum alone, in bytes a second.
#include <cstdint>
#include <vector>

#include "benchmark/decode_recording.hpp"
#include "drivers/ouster/crc64.hpp"
#include "support/ouster_packets.hpp"

namespace {

using landfix::drivers::ouster::Profile;
using landfix::test::Recording;

constexpr std::int64_t kStartUtcNs = 1'700'002'800'000'000'000;
constexpr std::int64_t kPacketNs = 1'562'500;

/// Half of the second returns are equal to the first, one record in ten is empty, at no regular places.
Recording record(const landfix::drivers::ouster::Metadata& metadata, std::size_t turns, bool checked) {
  const auto& pixel = landfix::drivers::ouster::pixel_of(metadata.profile);
  Recording recording{.records_a_packet = 16 * metadata.row_count * pixel.returns()};
  std::uint32_t random = 1;
  for (std::size_t i = 0; i < 64 * turns; ++i) {
    const std::int64_t utc_ns = kStartUtcNs + static_cast<std::int64_t>(i) * kPacketNs;
    landfix::test::OusterPacket packet(metadata);
    packet.set_frame(static_cast<std::uint32_t>(i / 64));
    packet.set_place(i % 64, utc_ns);
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
    recording.add(packet.bytes(), utc_ns);
  }
  return recording;
}

void decode(benchmark::State& state, const char* name, Profile profile, bool checked) {
  const auto& model = *landfix::drivers::find_sensor_model(name);
  const auto metadata = landfix::test::ouster_metadata(profile, model.beam_count);
  landfix::test::decode_recording(state, model, landfix::drivers::make_decoder(model, {}, metadata),
                                  record(metadata, 4, checked));
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
