// Hesai's rows of the catalogue, from the user manuals. Included by drivers/sensor_model.cpp alone.
#pragma once

#include <algorithm>
#include <array>

#include "drivers/beam_tables.hpp"
#include "drivers/hesai/wire.hpp"
#include "drivers/sensor_model.hpp"

namespace landfix::drivers::hesai {

inline constexpr std::array<std::uint16_t, 4> kPandar64PayloadSizes{
    packet_bytes(6), packet_bytes(6) + kSequenceBytes, packet_bytes(7), packet_bytes(7) + kSequenceBytes};

inline bool recognise_pandar64(const SensorModel& /*model*/, std::span<const std::byte> payload) noexcept {
  return std::ranges::find(kPandar64PayloadSizes, payload.size()) != kPandar64PayloadSizes.end() &&
         load_little_endian<std::uint16_t>(payload.data()) == 0xFFEE &&
         std::to_integer<std::size_t>(payload[2]) == kPandar64Lasers;
}

inline constexpr std::array kModels = {
    SensorModel{.name = "pandar64",
                .vendor = "Hesai",
                .display_name = "Pandar64",
                .format = PacketFormat::hesai_pandar64,
                .beam_count = beam_tables::pandar64.size(),
                .beams = beam_tables::pandar64,
                .calibration = CalibrationUse::optional,
                .rotation_hz = {10, 20},
                .min_range_m = 0.3,
                .max_range_m = 200.0,
                .range_precision_m = 0.02,
                .vertical_up_deg = 15.0,
                .vertical_down_deg = -25.0,
                .vertical_resolution_deg = 0.167,
                .horizontal_resolution_at_10_hz_deg = 0.2,
                .wavelength_nm = 905.0,
                .diameter_mm = 118.0,
                .height_mm = 116.7,
                .weight_kg = 1.52,
                .data_port = 2368,
                .payload_sizes = kPandar64PayloadSizes,
                .firing_period_us = 55.56,
                .max_returns = 2,
                .recognise = recognise_pandar64},
};

}  // namespace landfix::drivers::hesai
