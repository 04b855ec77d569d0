// The input replaces bytes of a sound file, so that the fuzzer need not find whole files by chance; or it is
// read as it is.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>

#include "drivers/make_decoder.hpp"
#include "drivers/ouster/metadata_file.hpp"

namespace {

using landfix::drivers::ouster::Metadata;

constexpr std::string_view kSound = R"({
 "sensor_info": {"prod_line": "OS-1-16-A0", "prod_sn": "991", "prod_pn": "840-1"},
 "beam_intrinsics": {"beam_altitude_angles": [9,8,7,6,5,4,3,2,1,0,-1,-2,-3,-4,-5,-6],
  "beam_azimuth_angles": [3,1,-1,-3,3,1,-1,-3,3,1,-1,-3,3,1,-1,-3],
  "lidar_origin_to_beam_origin_mm": 12.1,
  "beam_to_lidar_transform": [1,0,0,12.1,0,1,0,0,0,0,1,0,0,0,0,1]},
 "lidar_intrinsics": {"lidar_to_sensor_transform": [-1,0,0,0,0,-1,0,0,0,0,1,36,0,0,0,1]},
 "lidar_data_format": {"pixels_per_column": 16, "columns_per_packet": 16, "columns_per_frame": 512,
  "column_window": [370,85], "udp_profile_lidar": "RNG19_RFL8_SIG16_NIR16", "header_type": "FUSA", "fps": 10},
 "config_params": {"lidar_mode": "512x10"}})";

void check(const Metadata& metadata) {
  namespace drivers = landfix::drivers;
  if (metadata.row_count > drivers::ouster::kMaxRows || metadata.beam_count != 16) std::abort();
  if (metadata.window.first >= metadata.columns_per_frame) std::abort();
  if (metadata.window.last >= metadata.columns_per_frame) std::abort();
  auto decoder = drivers::make_decoder(*drivers::find_sensor_model("os1-16"), {}, metadata);
  std::vector<drivers::Point> storage(200);
  drivers::SweepPair sweeps(storage);
  const auto shape =
      drivers::ouster::packet_shape(metadata.profile, metadata.row_count, metadata.columns_per_packet);
  const std::vector<std::byte> packet(shape.packet_bytes);
  static_cast<void>(decoder.decode({.payload = packet}, sweeps));
}

void parse(std::span<const std::byte> file) {
  try {
    check(landfix::drivers::ouster::parse_metadata(*landfix::drivers::find_sensor_model("os1-16"), file,
                                                   "fuzz"));
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  parse(std::as_bytes(std::span(data, size)));
  // Each change: where (two bytes), how many characters go, what comes instead.
  std::string text(kSound);
  for (std::size_t at = 0; at + 4 <= size; at += 4) {
    const std::size_t where = (data[at] + std::size_t{256} * data[at + 1]) % text.size();
    text.replace(where, data[at + 2] % 4U, 1, static_cast<char>(data[at + 3]));
  }
  parse(std::as_bytes(std::span(text)));
  return 0;
}
