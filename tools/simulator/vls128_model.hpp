// VLS-128 and Alpha Prime as their maker describes them: 128 lasers in four banks (VLS-128 User Manual
// 63-9483 Rev A, chapters 8 and 9), with the slot time of a recorded unit: the manual's is that of one
// firmware only.
#pragma once

#include <cstdint>
#include <memory>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator {

enum class Vls128Variant : std::uint8_t { vls128, alpha_prime };

[[nodiscard]] std::unique_ptr<LidarModel> make_vls128(Vls128Variant variant);

}  // namespace landfix::tools::simulator
