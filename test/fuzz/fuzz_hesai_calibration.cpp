#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>

#include "drivers/hesai/calibration.hpp"
#include "drivers/sensor_model.hpp"
#include "fuzz/fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Few channels, and those near zero, so that the fuzzer can find whole files.
  static const auto table = landfix::drivers::find_sensor_model("pandar64")->beams.subspan(17, 3);
  static const std::string sound = [] {
    std::string text = "Laser id,Elevation,Azimuth\n";
    for (std::size_t i = 0; i < table.size(); ++i) {
      text += std::to_string(i + 1) + "," + std::to_string(table[i].elevation_deg) + "," +
              std::to_string(table[i].azimuth_offset_deg) + "\n";
    }
    return text;
  }();
  const std::string text = landfix::test::fuzzed_text(sound, std::span(data, size));
  try {
    const auto beams =
        landfix::drivers::hesai::parse_calibration(std::as_bytes(std::span(text)), "fuzz", table);
    if (beams.size() != table.size()) std::abort();
  } catch (const std::runtime_error&) {  // refused, as it should be
  }
  return 0;
}
