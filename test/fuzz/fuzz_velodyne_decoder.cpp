#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

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

}  // namespace

/// The first byte says which sensor, the rest what becomes of its packet.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Sensor& sensor = kSensors[data[0] % kSensors.size()];
  landfix::test::VelodynePacket sound(sensor.product, sensor.mode);
  const std::size_t blocks_a_sequence = std::max<std::size_t>(4 * sensor.blocks_a_bank, 1);
  for (std::size_t block = 0; sensor.blocks_a_bank != 0 && block < 12; ++block) {
    const std::size_t bank = block % blocks_a_sequence / sensor.blocks_a_bank;
    const bool is_left_over = block / blocks_a_sequence == 12 / blocks_a_sequence;
    sound.set_flag(block, is_left_over ? 0 : landfix::drivers::velodyne::kBankFlags[bank]);
  }
  sound.set_azimuths(35900, 40, blocks_a_sequence);
  for (std::size_t slot = 0; slot < 32; ++slot) sound.set_return(3, slot, 1000);
  landfix::test::fuzz_decoder(sensor.name, sound.bytes(), std::as_bytes(std::span(data, size).subspan(1)));
  return 0;
}
