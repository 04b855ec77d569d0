// Velodyne's rows of the catalogue, from the data sheets. Included by drivers/sensor_model.cpp alone.
#pragma once

#include <algorithm>
#include <array>

#include "drivers/beam_tables.hpp"
#include "drivers/sensor_model.hpp"
#include "drivers/velodyne/block_layout.hpp"
#include "drivers/velodyne/hdl64_calibration.hpp"
#include "drivers/velodyne/hdl64_wire.hpp"
#include "drivers/velodyne/wire.hpp"

namespace landfix::drivers::velodyne {

inline constexpr std::array<std::uint16_t, 1> kPayloadSizes{sizeof(WirePacket)};

/// All but the HDL-64E, whose last byte may be anything, name themselves there.
inline bool names_itself(const SensorModel& model, std::span<const std::byte> payload) noexcept {
  return payload.size() == sizeof(WirePacket) && payload.back() == std::byte{model.product_id} &&
         flag_of_block(payload, 0) == kBlockFlag;
}

inline bool recognise_blocks(const SensorModel& model, std::span<const std::byte> payload) noexcept {
  return names_itself(model, payload) && flag_of_block(payload, 1) == kBlockFlag &&
         flag_of_block(payload, 11) == kBlockFlag;
}

/// Four banks: three sequences a packet, or one and four blocks that are left over, or three blocks each.
inline bool recognise_vls128(const SensorModel& /*model*/, std::span<const std::byte> payload) noexcept {
  if (payload.size() != sizeof(WirePacket)) return false;
  const bool named = payload.back() == kVls128Product || payload.back() == kVls128ProductOfTheManual;
  return named && flag_of_block(payload, 0) == kBlockFlag &&
         (flag_of_block(payload, 3) == kBankFlags[3] || flag_of_block(payload, 7) == kBankFlags[3] ||
          flag_of_block(payload, 11) == kBankFlags[3]);
}

/// What the order of the blocks leaves open: one return of an S2 looks like that of an S3, and of an S1 that
/// sends its blocks in pairs.
inline bool recognise_hdl64(const SensorModel& model, std::span<const std::byte> payload) noexcept {
  const auto layout = hdl64_layout(payload);
  if (!layout) return false;
  switch (*layout) {
    case Hdl64Layout::single:
      return true;
    case Hdl64Layout::dual:
      return model.format == PacketFormat::velodyne_hdl64_s3;
    case Hdl64Layout::s1:
      break;
  }
  return model.format == PacketFormat::velodyne_hdl64_s1;
}

inline constexpr SensorModel kVls128Model{.name = "vls128",
                                          .vendor = "Velodyne",
                                          .display_name = "VLS-128",
                                          .format = PacketFormat::velodyne_vls128,
                                          .beam_count = beam_tables::vls128.size(),
                                          .beams = beam_tables::vls128,
                                          .calibration = CalibrationUse::optional,
                                          .rotation_hz = {5, 10, 15, 20},
                                          .min_range_m = 1.0,
                                          .max_range_m = 245.0,
                                          .range_precision_m = 0.03,
                                          .vertical_up_deg = 15.0,
                                          .vertical_down_deg = -25.0,
                                          .vertical_resolution_deg = 0.11,
                                          .horizontal_resolution_at_10_hz_deg = 0.2,
                                          .wavelength_nm = 903.0,
                                          .diameter_mm = 165.5,
                                          .height_mm = 141.3,
                                          .weight_kg = 3.5,
                                          .data_port = 2368,
                                          .telemetry_port = 8308,
                                          .payload_sizes = kPayloadSizes,
                                          .product_id = std::to_integer<std::uint8_t>(kVls128Product),
                                          .firing_period_us = 53.3,
                                          .max_returns = 2,
                                          .recognise = recognise_vls128};

/// The same packets and the same table: no source tells their beams apart.
inline constexpr SensorModel kVls128ApModel = [] {
  SensorModel model = kVls128Model;
  model.name = "vls128ap";
  model.display_name = "Alpha Prime (VLS-128AP)";
  return model;
}();

inline constexpr std::array kModels = {
    kVls128ApModel,
    kVls128Model,
    // HDL-64E S2 and S2.1 User's Manual, HDL-64E S3 data sheet 63-9194; they have no table of beams: units
    // differ by degrees.
    SensorModel{.name = "hdl64s2",
                .vendor = "Velodyne",
                .display_name = "HDL-64E S2, S2.1",
                .format = PacketFormat::velodyne_hdl64_s2,
                .beam_count = kHdl64Lasers,
                .beams = {},
                .calibration = CalibrationUse::in_stream,
                .rotation_hz = {5, 10, 15},
                .min_range_m = 0.9,
                .max_range_m = 120.0,
                .range_precision_m = 0.02,
                .vertical_up_deg = 2.0,
                .vertical_down_deg = -24.8,
                .vertical_resolution_deg = 0.33,
                .horizontal_resolution_at_10_hz_deg = 0.17,
                .wavelength_nm = 905.0,
                .diameter_mm = 223.5,
                .height_mm = 283.0,
                .weight_kg = 13.2,
                .data_port = 2368,
                .payload_sizes = kPayloadSizes,
                .firing_period_us = 48.0,
                .recognise = recognise_hdl64},
    SensorModel{.name = "hdl64s3",
                .vendor = "Velodyne",
                .display_name = "HDL-64E S3",
                .format = PacketFormat::velodyne_hdl64_s3,
                .beam_count = kHdl64Lasers,
                .beams = {},
                .calibration = CalibrationUse::in_stream,
                .rotation_hz = {5, 10, 15, 20},
                .min_range_m = 0.9,
                .max_range_m = 120.0,
                .range_precision_m = 0.02,
                .vertical_up_deg = 2.0,
                .vertical_down_deg = -24.8,
                .vertical_resolution_deg = 0.33,
                .horizontal_resolution_at_10_hz_deg = 0.17,
                .wavelength_nm = 905.0,
                .diameter_mm = 223.5,
                .height_mm = 283.0,
                .weight_kg = 12.7,
                .data_port = 2368,
                .payload_sizes = kPayloadSizes,
                .firing_period_us = 48.0,
                .max_returns = 2,
                .recognise = recognise_hdl64},
    // Its upper block fires three times as often as the lower one: twelve blocks of 32 in 384 us.
    SensorModel{.name = "hdl64s1",
                .vendor = "Velodyne",
                .display_name = "HDL-64E S1",
                .format = PacketFormat::velodyne_hdl64_s1,
                .beam_count = kHdl64Lasers,
                .beams = {},
                .calibration = CalibrationUse::required,
                .rotation_hz = {5, 10, 15},
                .min_range_m = 0.9,
                .max_range_m = 120.0,
                .range_precision_m = 0.05,
                .vertical_up_deg = 2.0,
                .vertical_down_deg = -24.8,
                .vertical_resolution_deg = 0.4,
                .horizontal_resolution_at_10_hz_deg = 0.12,
                .wavelength_nm = 905.0,
                .diameter_mm = 223.5,
                .height_mm = 283.0,
                .weight_kg = 13.2,
                .data_port = 2368,
                .payload_sizes = kPayloadSizes,
                .firing_period_us = 48.0,
                .recognise = recognise_hdl64},
    SensorModel{.name = "hdl32e",
                .vendor = "Velodyne",
                .display_name = "HDL-32E",
                .format = PacketFormat::velodyne_hdl32e,
                .beam_count = beam_tables::hdl32e.size(),
                .beams = beam_tables::hdl32e,
                .rotation_hz = {5, 10, 15, 20},
                .min_range_m = 1.0,
                .max_range_m = 100.0,
                .range_precision_m = 0.02,
                .vertical_up_deg = 10.67,
                .vertical_down_deg = -30.67,
                .vertical_resolution_deg = 1.33,
                .horizontal_resolution_at_10_hz_deg = 0.166,
                .wavelength_nm = 903.0,
                .diameter_mm = 85.3,
                .height_mm = 144.2,
                .weight_kg = 1.0,
                .data_port = 2368,
                .telemetry_port = 8308,
                .payload_sizes = kPayloadSizes,
                .product_id = kHdl32e.product,
                .firing_period_us = kHdl32e.sequence_us(),
                .max_returns = 2,
                .recognise = recognise_blocks},
    SensorModel{.name = "vlp32c",
                .vendor = "Velodyne",
                .display_name = "VLP-32C (Ultra Puck)",
                .format = PacketFormat::velodyne_vlp32c,
                .beam_count = beam_tables::vlp32c.size(),
                .beams = beam_tables::vlp32c,
                .rotation_hz = {5, 10, 15, 20},
                .min_range_m = 1.0,
                .max_range_m = 200.0,
                .range_precision_m = 0.03,
                .vertical_up_deg = 15.0,
                .vertical_down_deg = -25.0,
                .vertical_resolution_deg = 0.333,
                .horizontal_resolution_at_10_hz_deg = 0.2,
                .wavelength_nm = 903.0,
                .diameter_mm = 103.0,
                .height_mm = 86.9,
                .weight_kg = 0.925,
                .data_port = 2368,
                .telemetry_port = 8308,
                .payload_sizes = kPayloadSizes,
                .product_id = kVlp32c.product,
                .firing_period_us = kVlp32c.sequence_us(),
                .max_returns = 2,
                .recognise = recognise_blocks},
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
                .product_id = kVlp16.product,
                .firing_period_us = kVlp16.sequence_us(),
                .max_returns = 2,
                .recognise = recognise_blocks},
    SensorModel{.name = "vlp16hires",
                .vendor = "Velodyne",
                .display_name = "Puck Hi-Res",
                .format = PacketFormat::velodyne_vlp16hires,
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
                .product_id = kVlp16HiRes.product,
                .firing_period_us = kVlp16HiRes.sequence_us(),
                .max_returns = 2,
                .recognise = recognise_blocks},
};

}  // namespace landfix::drivers::velodyne
