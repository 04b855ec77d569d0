// RoboSense's rows of the catalogue, from the user manuals. Included by drivers/sensor_model.cpp alone.
#pragma once

#include <array>

#include "drivers/robosense/data_packet.hpp"
#include "drivers/sensor_model.hpp"

namespace landfix::drivers::robosense {

inline constexpr std::array<std::uint16_t, 1> kPayloadSizes{kPacketBytes};
inline constexpr std::uint16_t kDataPort = 6699;
inline constexpr std::uint16_t kDeviceInfoPort = 7788;

/// The RS-LiDAR-16 and -32 cannot be told apart by it.
template <const Description& model>
bool recognise(const SensorModel& /*row*/, std::span<const std::byte> payload) noexcept {
  return payload.size() == kPacketBytes && has_magic_of(model, payload);
}

inline constexpr std::array kModels = {
    SensorModel{.name = "rs32",
                .vendor = "RoboSense",
                .display_name = "RS-LiDAR-32",
                .format = PacketFormat::robosense_rs32,
                .beam_count = kRs32.lasers,
                .beams = {},
                .calibration = CalibrationUse::in_stream,
                .rotation_hz = {5, 10, 20},
                .min_range_m = 0.4,
                .max_range_m = 200.0,
                .range_precision_m = 0.03,
                .vertical_up_deg = 15.0,
                .vertical_down_deg = -25.0,
                .vertical_resolution_deg = 0.33,
                .horizontal_resolution_at_10_hz_deg = 0.2,
                .wavelength_nm = 905.0,
                .diameter_mm = 114.0,
                .height_mm = 108.73,
                .weight_kg = 1.17,
                .data_port = kDataPort,
                .telemetry_port = kDeviceInfoPort,
                .payload_sizes = kPayloadSizes,
                .firing_period_us = kRs32.firing_period_us,
                .max_returns = 2,
                .recognise = recognise<kRs32>},
    SensorModel{.name = "rs16",
                .vendor = "RoboSense",
                .display_name = "RS-LiDAR-16",
                .format = PacketFormat::robosense_rs16,
                .beam_count = kRs16.lasers,
                .beams = {},
                .calibration = CalibrationUse::in_stream,
                .rotation_hz = {5, 10, 20},
                .min_range_m = 0.2,
                .max_range_m = 150.0,
                .range_precision_m = 0.02,
                .vertical_up_deg = 15.0,
                .vertical_down_deg = -15.0,
                .vertical_resolution_deg = 2.0,
                .horizontal_resolution_at_10_hz_deg = 0.2,
                .wavelength_nm = 905.0,
                .diameter_mm = 109.0,
                .height_mm = 80.7,
                .weight_kg = 0.87,
                .data_port = kDataPort,
                .telemetry_port = kDeviceInfoPort,
                .payload_sizes = kPayloadSizes,
                .firing_period_us = kRs16.firing_period_us,
                .max_returns = 2,
                .recognise = recognise<kRs16>},
    SensorModel{.name = "helios16p",
                .vendor = "RoboSense",
                .display_name = "RS-Helios-16P",
                .format = PacketFormat::robosense_helios16p,
                .beam_count = kHelios16p.lasers,
                .beams = {},
                .calibration = CalibrationUse::in_stream,
                .rotation_hz = {10, 20},
                .min_range_m = 0.2,
                .max_range_m = 150.0,
                .range_precision_m = 0.02,
                .vertical_up_deg = 15.0,
                .vertical_down_deg = -15.0,
                .vertical_resolution_deg = 2.0,
                .horizontal_resolution_at_10_hz_deg = 0.2,
                .wavelength_nm = 905.0,
                .diameter_mm = 97.5,
                .height_mm = 100.0,
                .weight_kg = 1.0,
                .data_port = kDataPort,
                .telemetry_port = kDeviceInfoPort,
                .payload_sizes = kPayloadSizes,
                .firing_period_us = kHelios16p.firing_period_us,
                .max_returns = 2,
                .recognise = recognise<kHelios16p>},
};

}  // namespace landfix::drivers::robosense
