#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "drivers/velodyne/hdl64_calibration_file.hpp"
#include "fuzz/fuzz_file.hpp"
#include "support/hdl64_calibration_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // A unit with two lasers: to read all 64 tells no more, and takes as much longer.
  static const std::string sound =
      landfix::test::yaml_lasers(2) + "num_lasers: 2\ndistance_resolution: 0.002\n";
  const std::string text = landfix::test::fuzzed_text(sound, std::span(data, size));
  try {
    const auto calibration = landfix::drivers::velodyne::parse_hdl64_yaml(text, "fuzz");
    for (const auto& laser : calibration.lasers) {
      if (!std::isfinite(laser.elevation_deg + laser.rotation_deg + laser.range_m)) __builtin_trap();
    }
  } catch (const std::runtime_error&) {  // refused, as it should be
  }
  return 0;
}
