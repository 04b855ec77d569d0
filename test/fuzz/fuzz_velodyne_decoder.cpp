#include <array>
#include <cstdint>

#include "drivers/velodyne/wire.hpp"
#include "fuzz/fuzz_decoder.hpp"
#include "support/synthetic_packets.hpp"

namespace {

struct Sensor {
  const char* name;
  std::uint8_t product;
  bool has_banks;
};
constexpr std::array kSensors{Sensor{"vlp16", 0x22, false}, Sensor{"vlp32c", 0x28, false},
                              Sensor{"hdl32e", 0x21, false}, Sensor{"vls128", 0xA1, true}};

}  // namespace

/// The first byte says which sensor, the rest what becomes of its packet.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Sensor& sensor = kSensors[data[0] % kSensors.size()];
  landfix::test::VelodynePacket sound(sensor.product);
  if (sensor.has_banks) {
    for (std::size_t block = 0; block < 12; ++block) {
      sound.set_flag(block, landfix::drivers::velodyne::kBankFlags[block % 4]);
    }
  }
  sound.set_azimuths(35900, 40, sensor.has_banks ? 4 : 1);
  for (std::size_t slot = 0; slot < 32; ++slot) sound.set_return(3, slot, 1000);
  landfix::test::fuzz_decoder(sensor.name, sound.bytes(), std::as_bytes(std::span(data, size).subspan(1)));
  return 0;
}
