// Velodyne's rows of the catalogue, from the data sheets. Included by drivers/sensor_model.cpp alone.
#pragma once

#include <array>

#include "drivers/beam_tables.hpp"
#include "drivers/sensor_model.hpp"
#include "drivers/velodyne/wire.hpp"

namespace landfix::drivers::velodyne {

inline constexpr std::array<std::uint16_t, 1> kPayloadSizes{sizeof(WirePacket)};

/// All but the HDL-64E name themselves in the last byte.
inline bool recognise(const SensorModel& model, std::span<const std::byte> payload) noexcept {
  return payload.size() == sizeof(WirePacket) &&
         load_little_endian<std::uint16_t>(payload.data()) == kBlockFlag &&
         payload.back() == std::byte{model.product_id};
}

inline constexpr std::array kModels = {
    SensorModel{.name = "vlp16",
                .vendor = "Velodyne",
                .display_name = "VLP-16 (Puck, Puck LITE)",
                .format = PacketFormat::velodyne_vlp16,
                .beam_count = beam_tables::vlp16.size(),
                .beams = beam_tables::vlp16,
                .rotation_hz = {5, 10, 15, 20},
                .min_range_m = 0.5,
                .max_range_m = 100.0,
                .range_precision_m = 0.03,
                .vertical_up_deg = 15.0,
                .vertical_down_deg = -15.0,
                .vertical_resolution_deg = 2.0,
                .horizontal_resolution_at_10_hz_deg = 0.2,
                .wavelength_nm = 903.0,
                .diameter_mm = 103.3,
                .height_mm = 71.7,
                .weight_kg = 0.83,
                .data_port = 2368,
                .telemetry_port = 8308,
                .payload_sizes = kPayloadSizes,
                .product_id = 0x22,
                .firing_period_us = 55.296,
                .max_returns = 2,
                .recognise = recognise},
    SensorModel{.name = "vlp16hires",
                .vendor = "Velodyne",
                .display_name = "Puck Hi-Res",
                .format = PacketFormat::velodyne_vlp16,
                .beam_count = beam_tables::vlp16hires.size(),
                .beams = beam_tables::vlp16hires,
                .rotation_hz = {5, 10, 15, 20},
                .min_range_m = 0.5,
                .max_range_m = 100.0,
                .range_precision_m = 0.03,
                .vertical_up_deg = 10.0,
                .vertical_down_deg = -10.0,
                .vertical_resolution_deg = 1.33,
                .horizontal_resolution_at_10_hz_deg = 0.2,
                .wavelength_nm = 903.0,
                .diameter_mm = 103.3,
                .height_mm = 71.7,
                .weight_kg = 0.83,
                .data_port = 2368,
                .telemetry_port = 8308,
                .payload_sizes = kPayloadSizes,
                .product_id = 0x24,
                .firing_period_us = 55.296,
                .max_returns = 2,
                .recognise = recognise},
};

}  // namespace landfix::drivers::velodyne
