// Whether a payload is a lidar packet of a sensor with so many beams. LEGACY packets hold no mark at all and
// sizes mean different things for different numbers of beams, so that more than one sensor may answer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/ouster/wire.hpp"
#include "drivers/sensor_model.hpp"

namespace landfix::drivers::ouster {

/// Packets hold 16 columns in every mode there is.
inline constexpr std::size_t kColumnsPerPacket = 16;

/// Goes by size, header, and the columns' numbers, times, encoder counts and states.
[[nodiscard]] bool recognise(const SensorModel& model, std::span<const std::byte> payload) noexcept;

}  // namespace landfix::drivers::ouster
