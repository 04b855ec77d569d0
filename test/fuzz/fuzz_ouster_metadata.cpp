// A sensor's metadata file.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>

#include "drivers/make_decoder.hpp"
#include "drivers/ouster/metadata_file.hpp"
#include "fuzz/fuzz_file.hpp"

namespace {

using landfix::drivers::ouster::Metadata;

const std::string kSound = R"({
 "sensor_info": {"prod_line": "OS-1-16-A0", "prod_sn": "991", "prod_pn": "840-1"},
 "beam_intrinsics": {"beam_altitude_angles": [9,8,7,6,5,4,3,2,1,0,-1,-2,-3,-4,-5,-6],
  "beam_azimuth_angles": [3,1,-1,-3,3,1,-1,-3,3,1,-1,-3,3,1,-1,-3],
  "lidar_origin_to_beam_origin_mm": 12.1,
  "beam_to_lidar_transform": [1,0,0,12.1,0,1,0,0,0,0,1,0,0,0,0,1]},
 "lidar_intrinsics": {"lidar_to_sensor_transform": [-1,0,0,0,0,-1,0,0,0,0,1,36,0,0,0,1]},
 "lidar_data_format": {"pixels_per_column": 16, "columns_per_packet": 16, "columns_per_frame": 512,
  "column_window": [370,85], "udp_profile_lidar": "RNG19_RFL8_SIG16_NIR16", "header_type": "FUSA", "fps": 10},
 "config_params": {"lidar_mode": "512x10"}})";

const landfix::drivers::SensorModel& model() {
  static const auto& os1 = *landfix::drivers::find_sensor_model("os1-16");
  return os1;
}

/// What is read of a file must do for a decoder.
void check(const Metadata& metadata) {
  namespace drivers = landfix::drivers;
  if (metadata.row_count > drivers::ouster::kMaxRows || metadata.beam_count != 16) std::abort();
  if (metadata.window.first >= metadata.columns_per_frame) std::abort();
  if (metadata.window.last >= metadata.columns_per_frame) std::abort();
  auto decoder = drivers::make_decoder(model(), {}, metadata);
  std::array<drivers::Point, 200> storage;
  drivers::SweepPair sweeps(storage);
  const auto shape =
      drivers::ouster::packet_shape(metadata.profile, metadata.row_count, metadata.columns_per_packet);
  const std::vector<std::byte> packet(shape.packet_bytes);
  static_cast<void>(decoder.decode({.payload = packet}, sweeps));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = landfix::test::fuzzed_text(kSound, std::span(data, size));
  try {
    check(landfix::drivers::ouster::parse_metadata(model(), std::as_bytes(std::span(text)), "fuzz"));
  } catch (const std::runtime_error&) {  // refused, as it should be
  }
  return 0;
}
