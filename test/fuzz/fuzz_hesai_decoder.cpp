#include "fuzz/fuzz_decoder.hpp"
#include "support/synthetic_packets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  landfix::test::Pandar64Packet sound(0x39, 6, 1);
  sound.set_azimuths(35980, 20, 2);
  for (std::size_t slot = 0; slot < 64; ++slot) sound.set_return(3, slot, 1000);
  landfix::test::fuzz_decoder("pandar64", sound.bytes(), std::as_bytes(std::span(data, size)));
  return 0;
}
