// Pandar64 and Pandar40P as their maker describes them (user manuals, sections 1.2 and 3, appendices I and
// II).
#pragma once

#include <memory>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator {

enum class PandarVariant : std::uint8_t { pandar64, pandar40p };

[[nodiscard]] std::unique_ptr<LidarModel> make_pandar(PandarVariant variant);

}  // namespace landfix::tools::simulator
