#include "fuzz/fuzz_decoder.hpp"
#include "support/synthetic_packets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  landfix::test::VelodynePacket sound;
  sound.set_azimuths(35900, 40);
  for (std::size_t slot = 0; slot < 32; ++slot) sound.set_return(3, slot, 1000);
  landfix::test::fuzz_decoder("vlp16", sound.bytes(), std::as_bytes(std::span(data, size)));
  return 0;
}
