#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "fuzz/fuzz_file.hpp"
#include "platform/map_projector_info.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string sound =
      "projector_type: TransverseMercator\nvertical_datum: WGS84\nmgrs_grid: 54SUE\nscale_factor: 0.9996\n"
      "map_origin:\n  latitude: 35.6762\n  longitude: 139.6503\n  altitude: 10.0\n";
  const std::string text = landfix::test::fuzzed_text(sound, std::span(data, size));
  try {
    const auto reference = landfix::platform::parse_map_projector_info(text, "fuzz");
    if (!reference.projection) return 0;
    const auto position = landfix::platform::to_geodetic(*reference.projection, {1000.0, -2000.0, 30.0});
    if (!std::isfinite(position.latitude_deg + position.longitude_deg + position.altitude_m))
      __builtin_trap();
  } catch (const std::runtime_error&) {  // refused, as it should be
  }
  return 0;
}
