// VLP-32C and HDL-32E as their maker describes them: 32 lasers, one firing sequence a block (VLP-32C User
// Manual 63-9325 Rev B, chapter 9; HDL-32E User's Manual and its application note on packet times).
#pragma once

#include <cstdint>
#include <memory>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator {

enum class Velodyne32Variant : std::uint8_t { vlp32c, hdl32e };

[[nodiscard]] std::unique_ptr<LidarModel> make_velodyne32(Velodyne32Variant variant);

}  // namespace landfix::tools::simulator
