#include <array>
#include <cstdint>

#include "fuzz/fuzz_decoder.hpp"
#include "support/hdl64_packets.hpp"

/// The first byte says which generation, and whether its unit is known; else the status bytes may bring it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  constexpr std::array kModels{"hdl64s1", "hdl64s2", "hdl64s3"};
  const std::size_t model = data[0] % kModels.size();
  landfix::test::VelodynePacket sound = model == 0
                                            ? landfix::test::hdl64s1_packet(35900, 12)
                                            : landfix::test::hdl64_packet(35900, 20, model == 2 ? 2 : 1);
  for (std::size_t slot = 0; slot < 32; ++slot) sound.set_return(3, slot, 1000);
  landfix::drivers::Calibration calibration;
  if (model == 0 || data[0] >= 128) calibration = landfix::drivers::velodyne::Hdl64Calibration{};
  landfix::test::fuzz_decoder(kModels[model], sound.bytes(), std::as_bytes(std::span(data, size).subspan(1)),
                              calibration);
  return 0;
}
