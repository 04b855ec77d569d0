#include "drivers/sensor_model.hpp"

#include <algorithm>

#include "drivers/beam_tables.hpp"
#include "drivers/hesai/wire.hpp"
#include "drivers/velodyne/wire.hpp"

namespace landfix::drivers {
namespace {

// From the data sheets of the VLP-16 and the Puck Hi-Res, and the Pandar64 User Manual.
constexpr std::array kModels = {
    SensorModel{.name = "vlp16",
                .vendor = "Velodyne",
                .display_name = "VLP-16 (Puck, Puck LITE)",
                .format = PacketFormat::velodyne_vlp16,
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
                .payload_sizes = {sizeof(velodyne::WirePacket)},
                .product_id = 0x22,
                .firing_period_us = 55.296,
                .max_returns = 2},
    SensorModel{.name = "vlp16hires",
                .vendor = "Velodyne",
                .display_name = "Puck Hi-Res",
                .format = PacketFormat::velodyne_vlp16,
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
                .payload_sizes = {sizeof(velodyne::WirePacket)},
                .product_id = 0x24,
                .firing_period_us = 55.296,
                .max_returns = 2},
    SensorModel{.name = "pandar64",
                .vendor = "Hesai",
                .display_name = "Pandar64",
                .format = PacketFormat::hesai_pandar64,
                .beams = beam_tables::pandar64,
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
                .payload_sizes = {hesai::packet_bytes(6), hesai::packet_bytes(6) + hesai::kSequenceBytes,
                                  hesai::packet_bytes(7), hesai::packet_bytes(7) + hesai::kSequenceBytes},
                .firing_period_us = 55.56,
                .max_returns = 2},
};

}  // namespace

std::span<const SensorModel> sensor_models() noexcept { return kModels; }

const SensorModel* find_sensor_model(std::string_view name) noexcept {
  const auto* const found = std::ranges::find(kModels, name, &SensorModel::name);
  return found == kModels.end() ? nullptr : found;
}

bool looks_like(const SensorModel& model, std::span<const std::byte> payload) noexcept {
  if (payload.empty() ||
      std::ranges::find(model.payload_sizes, payload.size()) == model.payload_sizes.end()) {
    return false;
  }
  switch (model.format) {
    case PacketFormat::velodyne_vlp16:
      return load_little_endian<std::uint16_t>(payload.data()) == velodyne::kBlockFlag &&
             payload.back() == std::byte{model.product_id};
    case PacketFormat::hesai_pandar64:
      return load_little_endian<std::uint16_t>(payload.data()) == 0xFFEE &&
             std::to_integer<std::size_t>(payload[2]) == hesai::kPandar64Lasers;
  }
  return false;
}

}  // namespace landfix::drivers
