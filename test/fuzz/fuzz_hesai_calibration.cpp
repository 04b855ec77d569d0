#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>

#include "drivers/hesai/calibration.hpp"
#include "drivers/sensor_model.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Few channels, and those near zero, so that the fuzzer can find whole files.
  const auto table = landfix::drivers::find_sensor_model("pandar64")->beams.subspan(17, 3);
  try {
    const auto beams =
        landfix::drivers::hesai::parse_calibration(std::as_bytes(std::span(data, size)), "fuzz", table);
    if (beams.size() != table.size()) std::abort();
  } catch (const std::runtime_error&) {
  }
  return 0;
}
