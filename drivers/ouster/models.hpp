// Ouster's rows of the catalogue, from the data sheets: a row a name, made of what the three families and
// the numbers of beams have in common. Included by drivers/sensor_model.cpp alone.
#pragma once

#include <array>

#include "drivers/ouster/recognise.hpp"
#include "drivers/sensor_model.hpp"

namespace landfix::drivers::ouster {

/// The sizes of all profiles for so many beams; of two with one size both.
template <std::size_t Beams>
inline constexpr auto kPayloadSizes = [] {
  const auto size = [](Profile profile, std::size_t rows) {
    return static_cast<std::uint16_t>(packet_shape(profile, rows, kColumnsPerPacket).packet_bytes);
  };
  return std::array{size(Profile::legacy, Beams),
                    size(Profile::legacy, Beams < kRowsOfOldFirmware ? kRowsOfOldFirmware : Beams),
                    size(Profile::single, Beams),
                    size(Profile::dual, Beams),
                    size(Profile::low_rate, Beams),
                    size(Profile::low_rate_dual, Beams),
                    size(Profile::five_words, Beams)};
}();

/// What all sensors of a family share.
struct Family {
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  double range_precision_m = 0.0;
  double half_field_deg = 0.0;  ///< the field of view is symmetric
  double wavelength_nm = 0.0;
  double diameter_mm = 0.0;
  double height_mm = 0.0;
  double weight_kg = 0.0;
};
inline constexpr Family kOs0{0.3, 75.0, 0.02, 45.0, 865.0, 87.0, 74.5, 0.445};
inline constexpr Family kOs1{0.3, 170.0, 0.02, 22.5, 865.0, 87.0, 74.5, 0.447};
/// The first generation, of 16 and 64 beams: the sensor of most published comparisons.
inline constexpr Family kOs1Gen1{0.8, 120.0, 0.03, 16.6, 850.0, 85.0, 73.5, 0.425};
inline constexpr Family kOs2{1.0, 240.0, 0.03, 11.25, 865.0, 119.0, 98.5, 1.1};

template <std::size_t Beams>
constexpr SensorModel row(std::string_view name, std::string_view display_name, const Family& family,
                          double vertical_resolution_deg) {
  return {.name = name,
          .vendor = "Ouster",
          .display_name = display_name,
          .format = PacketFormat::ouster,
          .beam_count = Beams,
          .beams = {},  // each unit has its own
          .calibration = CalibrationUse::required,
          .rotation_hz = {10, 20},
          .min_range_m = family.min_range_m,
          .max_range_m = family.max_range_m,
          .range_precision_m = family.range_precision_m,
          .vertical_up_deg = family.half_field_deg,
          .vertical_down_deg = -family.half_field_deg,
          .vertical_resolution_deg = vertical_resolution_deg,
          .horizontal_resolution_at_10_hz_deg = 0.18,
          .wavelength_nm = family.wavelength_nm,
          .diameter_mm = family.diameter_mm,
          .height_mm = family.height_mm,
          .weight_kg = family.weight_kg,
          .data_port = 7502,
          .telemetry_port = 7503,
          .payload_sizes = kPayloadSizes<Beams>,
          .firing_period_us = 48.83,  // 2048 columns at 10 Hz
          .max_returns = 2,
          .recognise = recognise};
}

inline constexpr std::array kModels = {
    row<32>("os0-32", "OS0-32", kOs0, 2.9),     row<64>("os0-64", "OS0-64", kOs0, 1.43),
    row<128>("os0-128", "OS0-128", kOs0, 0.71), row<16>("os1-16", "OS1-16", kOs1Gen1, 2.21),
    row<32>("os1-32", "OS1-32", kOs1, 1.45),    row<64>("os1-64", "OS1-64", kOs1Gen1, 0.53),
    row<128>("os1-128", "OS1-128", kOs1, 0.35), row<32>("os2-32", "OS2-32", kOs2, 0.73),
    row<64>("os2-64", "OS2-64", kOs2, 0.36),    row<128>("os2-128", "OS2-128", kOs2, 0.18),
};

}  // namespace landfix::drivers::ouster
