// HDL-64E S1, S2 and S3 as their maker describes them (HDL-64E S2 and S2.1 User's Manual, firmware 4.07;
// HDL-64E S3 User's Manual 63-HDL64ES3), and the S1 as recordings show it.
#pragma once

#include <memory>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator {

enum class Hdl64Variant : std::uint8_t { s1, s2, s3 };

[[nodiscard]] std::unique_ptr<LidarModel> make_hdl64(Hdl64Variant variant);

}  // namespace landfix::tools::simulator
