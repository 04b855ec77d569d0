#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/velodyne/hdl64_calibration_file.hpp"
#include "fuzz/fuzz_file.hpp"
#include "support/hdl64_calibration_text.hpp"

namespace {

/// A unit with three lasers: to read all 64 tells no more, and takes as much longer.
std::string sound_file() {
  using landfix::test::xml_array;
  constexpr int kLasers = 3;
  std::vector<int> enabled(64);
  std::fill_n(enabled.begin(), kLasers, 1);
  return landfix::test::xml_points(kLasers) + xml_array("enabled_", enabled) +
         xml_array("minIntensity_", {20, 30}) + xml_array("maxIntensity_", {200, 210, 220}) +
         landfix::test::kHdl64XmlEnd;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string sound = sound_file();
  const std::string text = landfix::test::fuzzed_text(sound, std::span(data, size));
  try {
    const auto calibration = landfix::drivers::velodyne::parse_hdl64_db_xml(text, "fuzz");
    for (const auto& laser : calibration.lasers) {
      if (!std::isfinite(laser.elevation_deg + laser.rotation_deg + laser.range_m)) __builtin_trap();
    }
  } catch (const std::runtime_error&) {  // refused, as it should be
  }
  return 0;
}
