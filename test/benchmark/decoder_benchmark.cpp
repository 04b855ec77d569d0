// Velodyne's and Hesai's sensors, but for the HDL-64E.
#include <array>
#include <cstdint>

#include "benchmark/decode_recording.hpp"
#include "support/synthetic_packets.hpp"

namespace {

using landfix::test::range_raw;
using landfix::test::Recording;

constexpr std::int64_t kHourUtcNs = 1'700'002'800'000'000'000;

/// What a Velodyne's packet looks like.
struct Velodyne {
  const char* name;
  std::uint8_t product;
  double firing_us;   ///< from one azimuth to the next
  std::size_t banks;  ///< blocks that share an azimuth, for each return
};
constexpr Velodyne kVlp16{"vlp16", 0x22, 110.592, 1};
constexpr Velodyne kVlp32c{"vlp32c", 0x28, 55.296, 1};
constexpr Velodyne kHdl32e{"hdl32e", 0x21, 46.08, 1};
constexpr Velodyne kVls128{"vls128", 0xA1, 55.3, 4};

/// One second at 600 rpm.
Recording velodyne(const Velodyne& sensor, std::size_t returns) {
  constexpr std::array<std::uint16_t, 4> kBankFlags{0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
  const std::size_t blocks_a_firing = sensor.banks * returns;
  const std::size_t firings = 12 / blocks_a_firing;
  const std::size_t used = firings * blocks_a_firing;
  Recording recording{.records_a_packet = used * 32};
  const auto step_centideg = static_cast<unsigned>(sensor.firing_us * 0.36);
  for (unsigned i = 0; i * static_cast<double>(firings) * sensor.firing_us < 1e6; ++i) {
    landfix::test::VelodynePacket packet(sensor.product, returns == 2 ? 0x39 : 0x37);
    const double time_us = i * static_cast<double>(firings) * sensor.firing_us;
    const unsigned azimuth_centideg = static_cast<unsigned>(time_us * 0.36) % 36000;
    packet.set_azimuths(azimuth_centideg, step_centideg, blocks_a_firing);
    packet.set_time_us(static_cast<std::uint32_t>(time_us) + 100);
    for (std::size_t block = 0; block < 12; ++block) {
      if (sensor.banks > 1) {
        packet.set_flag(block, block < used ? kBankFlags[block % blocks_a_firing / returns] : 0xFFFF);
      }
      for (std::size_t slot = 0; slot < 32; ++slot) {
        packet.set_return(block, slot, range_raw(slot, i * firings + block / returns, block % returns == 1),
                          10);
      }
    }
    recording.add(packet.bytes(), kHourUtcNs + static_cast<std::int64_t>(time_us * 1e3));
  }
  return recording;
}

/// One second of a Pandar at 600 rpm: `make` writes the packet of a number.
template <class Make>
Recording pandar(std::size_t returns, Make make) {
  const landfix::test::PandarPacket shape = make(0);
  const std::size_t firings = shape.blocks() / returns;
  Recording recording{.records_a_packet = shape.blocks() * shape.lasers()};
  for (unsigned i = 0; i * firings < 18000; ++i) {
    landfix::test::PandarPacket packet = make(i);
    const double time_us = i * static_cast<double>(firings) * 55.56;
    packet.set_mode(returns == 2 ? 0x39 : 0x37);
    packet.set_azimuths(static_cast<unsigned>(time_us * 0.36) % 36000, 20, returns);
    packet.set_microseconds(static_cast<std::uint32_t>(time_us) % 1'000'000);
    for (std::size_t block = 0; block < packet.blocks(); ++block) {
      for (std::size_t slot = 0; slot < packet.lasers(); ++slot) {
        packet.set_return(block, slot, range_raw(slot, i * firings + block / returns, block % returns == 1),
                          10);
      }
    }
    recording.add(packet.bytes(),
                  landfix::test::PandarPacket::kDateUtcNs + static_cast<std::int64_t>(time_us * 1e3));
  }
  return recording;
}

void decode(benchmark::State& state, const char* name, const Recording& recording) {
  const auto& model = *landfix::drivers::find_sensor_model(name);
  landfix::test::decode_recording(state, model, landfix::drivers::make_decoder(model, {}), recording);
}

void decode_velodyne(benchmark::State& state, const Velodyne& sensor) {
  decode(state, sensor.name, velodyne(sensor, static_cast<std::size_t>(state.range(0))));
}
void decode_vlp16(benchmark::State& state) { decode_velodyne(state, kVlp16); }
void decode_vlp32c(benchmark::State& state) { decode_velodyne(state, kVlp32c); }
void decode_hdl32e(benchmark::State& state) { decode_velodyne(state, kHdl32e); }
void decode_vls128(benchmark::State& state) { decode_velodyne(state, kVls128); }
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

BENCHMARK(decode_vls128)->ArgName("returns")->Arg(1)->Arg(2);
BENCHMARK(decode_hdl32e)->ArgName("returns")->Arg(1)->Arg(2);
BENCHMARK(decode_vlp32c)->ArgName("returns")->Arg(1)->Arg(2);
BENCHMARK(decode_vlp16)->ArgName("returns")->Arg(1)->Arg(2);
BENCHMARK(decode_pandar64)->ArgName("returns")->Arg(1)->Arg(2);
BENCHMARK(decode_pandar40p)->ArgName("returns")->Arg(1)->Arg(2);

}  // namespace
