// The first byte says which sensor, the rest what becomes of its packets of data and device information.
#include <array>
#include <cstdint>

#include "fuzz/fuzz_decoder.hpp"
#include "support/robosense_packets.hpp"

namespace {

landfix::test::FuzzedSensor robosense(const char* name, bool calibrated,
                                      const landfix::drivers::DecoderOptions& options = {}) {
  landfix::test::RobosensePacket data(name);
  data.set_azimuths(35950, 20, options.range_unit_m ? 2 : 1);
  for (std::size_t slot = 0; slot < 32; ++slot) data.set_return(3, slot, 1000);
  const auto unit = landfix::test::robosense_unit(name);
  landfix::test::FuzzedSensor sensor{
      name,
      {landfix::test::to_bytes(data.bytes()), landfix::test::to_bytes(unit.bytes())},
      {},
      options,
      landfix::test::RobosensePacket::kTimeUtcNs};
  if (calibrated) sensor.hear_telemetry();
  return sensor;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array sensors{robosense("rs32", true),  robosense("rs32", true, {.range_unit_m = 0.01}),
                                  robosense("rs16", true),  robosense("helios16p", true),
                                  robosense("rs32", false), robosense("helios16p", false)};
  if (size == 0) return 0;
  landfix::test::fuzz_decoder(sensors[data[0] % sensors.size()],
                              std::as_bytes(std::span(data, size).subspan(1)));
  return 0;
}
