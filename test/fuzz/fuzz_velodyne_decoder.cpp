#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "drivers/velodyne/wire.hpp"
#include "fuzz/fuzz_decoder.hpp"
#include "support/synthetic_packets.hpp"

namespace {

struct Sensor {
  const char* name;
  std::uint8_t product;
  std::uint8_t mode;
  std::size_t blocks_a_bank;  ///< 0: there are no banks
};
/// The modes whose blocks are in another order than one return's: chance would not put them there.
constexpr std::array kSensors{Sensor{"vlp16", 0x22, 0x37, 0},  Sensor{"vlp32c", 0x28, 0x37, 0},
                              Sensor{"hdl32e", 0x21, 0x37, 0}, Sensor{"vls128", 0xA1, 0x37, 1},
                              Sensor{"vls128", 0xA1, 0x39, 2}, Sensor{"vls128", 0xA1, 0x3A, 3}};

std::vector<std::byte> data_packet(const Sensor& sensor) {
  landfix::test::VelodynePacket packet(sensor.product, sensor.mode);
  const std::size_t blocks_a_sequence = std::max<std::size_t>(4 * sensor.blocks_a_bank, 1);
  for (std::size_t block = 0; sensor.blocks_a_bank != 0 && block < 12; ++block) {
    const std::size_t bank = block % blocks_a_sequence / sensor.blocks_a_bank;
    const bool is_left_over = block / blocks_a_sequence == 12 / blocks_a_sequence;
    packet.set_flag(block, is_left_over ? 0 : landfix::drivers::velodyne::kBankFlags[bank]);
  }
  packet.set_azimuths(35900, 40, blocks_a_sequence);
  for (std::size_t slot = 0; slot < 32; ++slot) packet.set_return(3, slot, 1000);
  return landfix::test::to_bytes(packet.bytes());
}

/// Locked, 2023-11-14 22:00:00 UTC.
std::vector<std::byte> position_packet() {
  constexpr std::string_view kSentence =
      "$GPRMC,220000,A,3707.8178,N,12139.2690,W,010.3,188.2,141123,013.8,E,D*03";
  std::vector<std::byte> packet(512);
  packet[202] = std::byte{2};
  for (std::size_t i = 0; i < kSentence.size(); ++i) packet[206 + i] = static_cast<std::byte>(kSentence[i]);
  return packet;
}

}  // namespace

/// The first byte says which sensor, the rest what becomes of its packets.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto sensors = [] {
    std::vector<landfix::test::FuzzedSensor> fuzzed;
    for (const Sensor& sensor : kSensors) fuzzed.push_back({sensor.name, {data_packet(sensor)}});
    for (const Sensor& sensor : kSensors) {
      fuzzed.push_back({sensor.name, {data_packet(sensor), position_packet()}});
    }
    return fuzzed;
  }();
  if (size == 0) return 0;
  landfix::test::fuzz_decoder(sensors[data[0] % sensors.size()],
                              std::as_bytes(std::span(data, size).subspan(1)));
  return 0;
}
