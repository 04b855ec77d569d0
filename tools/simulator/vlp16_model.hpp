// VLP-16, Puck LITE and Puck Hi-Res as their maker describes them (VLP-16 User Manual 63-9243 Rev D, chapter
// 9).
#pragma once

#include <memory>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator {

enum class Vlp16Variant : std::uint8_t { puck, hi_res };

[[nodiscard]] std::unique_ptr<LidarModel> make_vlp16(Vlp16Variant variant);

}  // namespace landfix::tools::simulator
