// OS0, OS1 and OS2 as their maker describes them (Ouster sensor documentation, firmware 1.13 to 3.2).
#pragma once

#include <memory>
#include <string_view>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator {

/// `name`: one of ouster::units.
[[nodiscard]] std::unique_ptr<LidarModel> make_ouster(std::string_view name);

}  // namespace landfix::tools::simulator
