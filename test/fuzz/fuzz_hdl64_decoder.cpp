#include <cstdint>

#include "fuzz/fuzz_decoder.hpp"
#include "support/hdl64_packets.hpp"

namespace {

using landfix::drivers::velodyne::Hdl64Calibration;

landfix::test::FuzzedSensor hdl64(const char* name, landfix::test::VelodynePacket sound,
                                  const landfix::drivers::Calibration& calibration) {
  for (std::size_t slot = 0; slot < 32; ++slot) sound.set_return(3, slot, 1000);
  return {name, {landfix::test::to_bytes(sound.bytes())}, calibration};
}

std::vector<landfix::test::FuzzedSensor> generations() {
  const auto s1 = landfix::test::hdl64s1_packet(35900, 12);
  const auto s2 = landfix::test::hdl64_packet(35900, 20, 1);
  const auto s3 = landfix::test::hdl64_packet(35900, 20, 2);
  return {hdl64("hdl64s1", s1, Hdl64Calibration{}), hdl64("hdl64s2", s2, Hdl64Calibration{}),
          hdl64("hdl64s3", s3, Hdl64Calibration{}), hdl64("hdl64s2", s2, {}), hdl64("hdl64s3", s3, {})};
}

}  // namespace

/// The first byte says which generation, and whether its unit is known; else the status bytes may bring it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto sensors = generations();
  if (size == 0) return 0;
  landfix::test::fuzz_decoder(sensors[data[0] % sensors.size()],
                              std::as_bytes(std::span(data, size).subspan(1)));
  return 0;
}
