// Velodyne's sensors with one bank of lasers, as their maker describes them: VLP-16 with its variants (VLP-16
// User Manual 63-9243 Rev D, chapter 9), VLP-32C (VLP-32C User Manual 63-9325 Rev B, chapter 9) and HDL-32E
// (HDL-32E User's Manual and its application note on packet times).
#pragma once

#include <cstdint>
#include <memory>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator {

enum class VelodyneSensor : std::uint8_t { hdl32e, vlp32c, vlp16, vlp16hires };

[[nodiscard]] std::unique_ptr<LidarModel> make_velodyne(VelodyneSensor sensor);

}  // namespace landfix::tools::simulator
