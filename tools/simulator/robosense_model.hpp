// RS-LiDAR-32, RS-LiDAR-16 and Helios-16P as their maker describes them (user manuals), each one unit with
// angles of its own.
#pragma once

#include <memory>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator {

enum class RobosenseSensor : std::uint8_t { rs32, rs16, helios16p };

[[nodiscard]] std::unique_ptr<LidarModel> make_robosense(RobosenseSensor sensor);

}  // namespace landfix::tools::simulator
