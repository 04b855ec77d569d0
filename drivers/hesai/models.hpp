// Hesai's rows of the catalogue, from the user manuals. Included by drivers/sensor_model.cpp alone.
#pragma once

#include <array>

#include "drivers/beam_tables.hpp"
#include "drivers/hesai/pandar_layout.hpp"
#include "drivers/sensor_model.hpp"

namespace landfix::drivers::hesai {

inline constexpr std::array<std::uint16_t, 4> kPandar64PayloadSizes{
    kPandar64.packet_bytes(6), kPandar64.packet_bytes(6) + kSequenceBytes, kPandar64.packet_bytes(7),
    kPandar64.packet_bytes(7) + kSequenceBytes};
inline constexpr std::array<std::uint16_t, 2> kPandar40pPayloadSizes{
    kPandar40p.packet_bytes(10), kPandar40p.packet_bytes(10) + kSequenceBytes};

/// By the header, or where there is none by the marker of every block. An early PandarQT has the Pandar64's
/// header to the byte: nothing but the user can tell.
inline bool recognise(const SensorModel& model, std::span<const std::byte> payload) noexcept {
  if (!has_size_of(model, payload)) return false;
  const PandarLayout& layout = layout_of(model.beam_count);
  if (layout.header_bytes != 0) {
    return load_little_endian<std::uint16_t>(payload.data()) == kHeaderMarker &&
           std::to_integer<std::size_t>(payload[2]) == layout.lasers;
  }
  for (std::size_t block = 0; block < layout.blocks.front(); ++block) {
    if (load_little_endian<std::uint16_t>(&payload[layout.block_at(block)]) != kBlockMarker) return false;
  }
  return true;
}

inline constexpr std::array kModels = {
    SensorModel{.name = "pandar64",
                .vendor = "Hesai",
                .display_name = "Pandar64",
                .format = PacketFormat::hesai_pandar,
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
                .telemetry_port = 10110,
                .payload_sizes = kPandar64PayloadSizes,
                .firing_period_us = 55.56,
                .max_returns = 2,
                .recognise = recognise},
    SensorModel{.name = "pandar40p",
                .vendor = "Hesai",
                .display_name = "Pandar40P",
                .format = PacketFormat::hesai_pandar,
                .beam_count = beam_tables::pandar40p.size(),
                .beams = beam_tables::pandar40p,
                .calibration = CalibrationUse::optional,
                .rotation_hz = {10, 20},
                .min_range_m = 0.3,
                .max_range_m = 200.0,
                .range_precision_m = 0.02,
                .vertical_up_deg = 15.0,
                .vertical_down_deg = -25.0,
                .vertical_resolution_deg = 0.33,
                .horizontal_resolution_at_10_hz_deg = 0.2,
                .wavelength_nm = 905.0,
                .diameter_mm = 116.0,
                .height_mm = 124.3,
                .weight_kg = 1.52,
                .data_port = 2368,
                .telemetry_port = 10110,
                .payload_sizes = kPandar40pPayloadSizes,
                .firing_period_us = 55.56,
                .max_returns = 2,
                .recognise = recognise},
};

}  // namespace landfix::drivers::hesai
