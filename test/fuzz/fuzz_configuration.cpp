// A configuration file.
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "fuzz/fuzz_file.hpp"
#include "platform/configuration.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string sound = R"([sensor]
model = "vlp16"
calibration = "unit.csv"
address = "192.168.1.201"
port = 2368
cut_deg = 90.0
min_range_m = 3.0
max_range_m = 200
[vehicle]
sensor_pose = [0.0, 0.0, 1.9, 0.0, 0.0, 90.0]
[map]
file = "map.ndt"
[initial_pose]
pose = [1.0, 2.0, 0.0, 0.0, 0.0, 45.0]
[filter]
leaf_m = 2.0
[matcher]
resolution_m = 1.0
max_iterations = 50
[can]
interface = "can0"
base_id = 0x3A0
rate_hz = 10.0
fd = false
[metrics]
address = "127.0.0.1:9464"
[odometry]
track_m = 1.6
[[odometry.signal]]
role = "speed"
id = 0x1A0
start = 6
length = 15
order = "motorola"
scale = 0.01
unit = "km/h"
invalid_raw = [0x7FFF]
timeout_s = 0.2
[gnss]
antenna = [0.5, 0.0, 1.5]
accuracy_m = 3.0
[[gnss.signal]]
role = "latitude"
id = 0x1B0
start = 0
length = 32
signed = true
scale = 1e-7
[[gnss.signal]]
role = "longitude"
id = 0x1B0
start = 32
length = 32
signed = true
scale = 1e-7
unit = "deg"
)";
  try {
    (void)landfix::platform::parse_configuration(landfix::test::fuzzed_text(sound, std::span(data, size)),
                                                 "/fuzz/landfix.toml");
  } catch (const std::runtime_error&) {  // refused, as it should be
  }
  return 0;
}
