// The catalogue of sensors, a table of data: a new sensor of a known packet format is a row in its vendor's
// models.hpp and a CSV in config/sensors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/beam.hpp"

namespace landfix::drivers {

/// Which decoder reads a sensor's packets.
enum class PacketFormat : std::uint8_t {
  velodyne_vls128,
  velodyne_hdl64_s1,
  velodyne_hdl64_s2,
  velodyne_hdl64_s3,
  velodyne_hdl32e,
  velodyne_vlp32c,
  velodyne_vlp16,
  velodyne_vlp16hires,
  hesai_pandar,
  ouster,
  robosense_rs32,
  robosense_rs16,
  robosense_helios16p,
};

/// Where the beams of a unit come from.
enum class CalibrationUse : std::uint8_t {
  none,       ///< the model's table is every unit's
  optional,   ///< the model's table will do, the unit's own file is better
  in_stream,  ///< the packets bring it; a file is the alternative
  required,   ///< without the unit's file there are no points
};

/// "none", "optional", "in_stream", "required".
[[nodiscard]] std::string_view to_string(CalibrationUse use) noexcept;

/// The data sheet of a sensor, and what its packets look like.
struct SensorModel {
  std::string_view name;  ///< as on the command line and in configurations
  std::string_view vendor;
  std::string_view display_name;
  PacketFormat format{};

  std::size_t beam_count = 0;
  std::span<const Beam>
      beams;  ///< the model's own table, in the order of the packet; empty where there is none
  CalibrationUse calibration{};
  std::array<int, 4> rotation_hz{};  ///< typical choices, 0 where there are fewer
  double min_range_m = 0.0;          ///< of useful returns; decoders keep what is asked of them
  double max_range_m = 0.0;
  double range_precision_m = 0.0;  ///< typical accuracy, 1 sigma
  double vertical_up_deg = 0.0;    ///< upper and lower end of the field of view
  double vertical_down_deg = 0.0;
  double vertical_resolution_deg = 0.0;  ///< the finest
  double horizontal_resolution_at_10_hz_deg = 0.0;
  double wavelength_nm = 0.0;
  double diameter_mm = 0.0;
  double height_mm = 0.0;
  double weight_kg = 0.0;

  std::uint16_t data_port = 0;                   ///< UDP destination, as delivered
  std::uint16_t telemetry_port = 0;              ///< of position, status, calibration; 0: none
  std::span<const std::uint16_t> payload_sizes;  ///< of data packets
  std::uint8_t product_id = 0;                   ///< byte that names the model; 0 where there is none
  double firing_period_us = 0.0;                 ///< of all beams once, the shortest there is
  int max_returns = 1;                           ///< a beam's firing
  /// Whether a data packet names the model, or one that it cannot be told from. Null: nothing names it.
  bool (*recognise)(const SensorModel&, std::span<const std::byte> payload) noexcept = nullptr;

  /// Room for a sweep that is cut only by time, 1.5 turns at the slowest rotation, dual return.
  [[nodiscard]] constexpr std::size_t max_points_per_sweep() const noexcept {
    const double firings = 1.5e6 / (rotation_hz[0] * firing_period_us);
    return static_cast<std::size_t>(firings + 64.0) * beam_count * static_cast<std::size_t>(max_returns);
  }
};

/// In the order in which `landfix sensors` lists them.
[[nodiscard]] std::span<const SensorModel> sensor_models() noexcept;

/// Null if there is none of that name.
[[nodiscard]] const SensorModel* find_sensor_model(std::string_view name) noexcept;

/// Whether a payload has the size and the identifying bytes of the model's data packets. Says nothing about
/// the rest of it.
[[nodiscard]] bool looks_like(const SensorModel& model, std::span<const std::byte> payload) noexcept;

/// Whether it has the size of one of the model's data packets, which is less.
[[nodiscard]] bool has_size_of(const SensorModel& model, std::span<const std::byte> payload) noexcept;

}  // namespace landfix::drivers
