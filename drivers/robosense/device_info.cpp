#include "drivers/robosense/device_info.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/big_endian.hpp"

namespace landfix::drivers::robosense {
namespace {

constexpr std::array<std::uint8_t, 8> kMagic{0xA5, 0xFF, 0x00, 0x5A, 0x11, 0x11, 0x55, 0x55};
constexpr std::size_t kRpmAt = 8;
constexpr std::size_t kTopFirmwareAt = 40;
constexpr std::size_t kBottomFirmwareAt = 45;
constexpr std::size_t kReturnModeAt = 300;
constexpr std::uint8_t kDualReturn = 0x00;

constexpr unsigned kFastestRpm = 3000;
constexpr double kSteepestDeg = 90.0;
/// Units differ from the nominal elevations by 0.07 deg; other models by several degrees.
constexpr double kSameModelDeg = 1.0;

/// Versions of the RS-LiDAR-32's top board that count centimetres (the maker's older driver). The list is
/// known to be incomplete: hence DecoderOptions::range_unit_m.
bool counts_centimetres(std::uint32_t top_firmware) noexcept {
  return top_firmware == 0x000000 || top_firmware == 0xFFFFFF || top_firmware == 0x55AA5A ||
         top_firmware == 0xE90100;
}

/// Nothing where the bytes are not what a programmed unit sends.
std::optional<double> angle_deg(const AngleTable& table, const std::byte* field, bool lower_half) noexcept {
  if (table.form == AngleForm::lower_half) {
    const auto magnitude = load_big_endian<std::uint32_t, 3>(field);
    if (magnitude == 0xFFFFFF) return std::nullopt;
    return (lower_half ? -table.unit_deg : table.unit_deg) * magnitude;
  }
  const auto sign = std::to_integer<unsigned>(field[0]);
  if (sign > 1) return std::nullopt;
  const double magnitude_deg = load_big_endian<std::uint16_t>(field + 1) * table.unit_deg;
  return sign == 1 ? -magnitude_deg : magnitude_deg;
}

std::optional<UnitAngles> read_angles(const Description& model, std::span<const std::byte> payload) noexcept {
  const AngleTable& table = model.angles;
  UnitAngles angles;
  for (std::size_t i = 0; i < model.lasers; ++i) {
    const bool lower_half = i < model.lasers / 2;
    const auto elevation = angle_deg(table, &payload[table.vertical_at + 3 * i], lower_half);
    const auto offset = table.horizontal_at == 0
                            ? std::optional(0.0)
                            : angle_deg(table, &payload[table.horizontal_at + 3 * i], false);
    if (!elevation || !offset) return std::nullopt;
    angles[i] = {.elevation_deg = *elevation, .azimuth_offset_deg = *offset};
  }
  const auto of_unit = std::span(angles).first(model.lasers);
  const bool blank =
      std::ranges::all_of(of_unit, [](const LaserAngles& a) { return a.elevation_deg == 0.0; });
  return blank ? std::nullopt : std::optional(angles);
}

bool fit(const Description& model, const UnitAngles& angles) noexcept {
  std::array<double, kMaxLasers> storage;
  const auto elevations_deg = std::span(storage).first(model.lasers);
  for (std::size_t i = 0; i < model.lasers; ++i) {
    if (std::abs(angles[i].elevation_deg) > kSteepestDeg) return false;
    if (std::abs(angles[i].azimuth_offset_deg) > kSteepestDeg) return false;
    elevations_deg[i] = angles[i].elevation_deg;
  }
  if (model.nominal_elevations_deg.empty()) return true;
  std::sort(elevations_deg.begin(), elevations_deg.end());
  return std::ranges::equal(elevations_deg, model.nominal_elevations_deg,
                            [](double a, double b) { return std::abs(a - b) <= kSameModelDeg; });
}

/// Whether another model's angles are where that model has them, and this one's field is blank.
bool is_of_another(const Description& model, std::span<const std::byte> payload) noexcept {
  return std::ranges::any_of(std::array{&kRs32, &kRs16}, [&](const Description* other) {
    if (other == &model) return false;
    const auto angles = read_angles(*other, payload);
    return angles && fit(*other, *angles);
  });
}

}  // namespace

bool is_device_info(std::span<const std::byte> payload) noexcept {
  return payload.size() >= kMagic.size() &&
         std::equal(kMagic.begin(), kMagic.end(), payload.begin(),
                    [](std::uint8_t expected, std::byte found) { return std::byte{expected} == found; });
}

DecodeStatus read_device_info(const Description& model, std::span<const std::byte> payload,
                              DeviceInfo& info) noexcept {
  if (payload.size() != kPacketBytes) return DecodeStatus::wrong_size;
  if (load_big_endian<std::uint16_t>(&payload[kTailAt]) != kDeviceInfoTail) return DecodeStatus::wrong_header;
  info.motor_rpm = load_big_endian<std::uint16_t>(&payload[kRpmAt]);
  if (info.motor_rpm > kFastestRpm) return DecodeStatus::wrong_header;
  info.counts_centimetres =
      model.had_centimetre_firmware &&
      counts_centimetres(load_big_endian<std::uint32_t, 3>(&payload[kTopFirmwareAt + 1]));
  if (load_big_endian<std::uint32_t, 3>(&payload[kBottomFirmwareAt]) >= model.return_mode_since) {
    info.dual_return = std::to_integer<std::uint8_t>(payload[kReturnModeAt]) == kDualReturn;
  }
  info.angles = read_angles(model, payload);
  if (info.angles ? !fit(model, *info.angles) : is_of_another(model, payload))
    return DecodeStatus::wrong_model;
  return DecodeStatus::telemetry;
}

}  // namespace landfix::drivers::robosense
