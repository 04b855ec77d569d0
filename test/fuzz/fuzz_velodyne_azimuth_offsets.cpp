#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "drivers/sensor_model.hpp"
#include "drivers/velodyne/azimuth_offsets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto table = landfix::drivers::find_sensor_model("vls128")->beams.first(3);
  try {
    const auto beams = landfix::drivers::velodyne::parse_azimuth_offsets(std::as_bytes(std::span(data, size)),
                                                                         "fuzz", table);
    if (beams.size() != table.size()) __builtin_trap();
  } catch (const std::runtime_error&) {  // refused, as it should be
  }
  return 0;
}
