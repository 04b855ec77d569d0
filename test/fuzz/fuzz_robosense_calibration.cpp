#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>

#include "drivers/robosense/calibration.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kLasers = 3;  // few, so that the fuzzer can find whole files
  try {
    const auto beams =
        landfix::drivers::robosense::parse_calibration(std::as_bytes(std::span(data, size)), "fuzz", kLasers);
    if (beams.size() != kLasers) std::abort();
    for (const auto& beam : beams) {
      if (beam.ring >= kLasers || !(beam.elevation_deg >= -90.0 && beam.elevation_deg <= 90.0)) std::abort();
    }
  } catch (const std::runtime_error&) {
  }
  return 0;
}
