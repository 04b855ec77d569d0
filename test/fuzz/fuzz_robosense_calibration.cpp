#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>

#include "drivers/robosense/calibration.hpp"
#include "fuzz/fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kLasers = 3;  // few, so that the fuzzer can find whole files
  static const std::string sound = "-10.281,8.0\n2.333,-8\n+0.333,-2.672\n";
  const std::string text = landfix::test::fuzzed_text(sound, std::span(data, size));
  try {
    const auto beams =
        landfix::drivers::robosense::parse_calibration(std::as_bytes(std::span(text)), "fuzz", kLasers);
    if (beams.size() != kLasers) std::abort();
    for (const auto& beam : beams) {
      if (beam.ring >= kLasers || !(beam.elevation_deg >= -90.0 && beam.elevation_deg <= 90.0)) std::abort();
    }
  } catch (const std::runtime_error&) {  // refused, as it should be
  }
  return 0;
}
