#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "drivers/sensor_model.hpp"
#include "drivers/velodyne/azimuth_offsets.hpp"
#include "fuzz/fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto table = landfix::drivers::find_sensor_model("vls128")->beams.first(3);
  static const std::string sound = "laser_id,azimuth_offset_deg\n0,0.03\n2,-0.1\n1,+1.5\n";
  const std::string text = landfix::test::fuzzed_text(sound, std::span(data, size));
  try {
    const auto beams =
        landfix::drivers::velodyne::parse_azimuth_offsets(std::as_bytes(std::span(text)), "fuzz", table);
    if (beams.size() != table.size()) __builtin_trap();
  } catch (const std::runtime_error&) {  // refused, as it should be
  }
  return 0;
}
