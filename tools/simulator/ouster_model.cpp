#include "tools/simulator/ouster_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/simulator/ouster_packets.hpp"
#include "tools/simulator/ouster_units.hpp"

namespace landfix::tools::simulator {
namespace {

using namespace ouster;

constexpr std::int64_t kOusterTurn_ns = 100'000'000;
constexpr std::uint32_t kInitId = 7'109'750;
constexpr std::uint64_t kSerialNumber = 122'201'000'998;
constexpr std::size_t kRowsOfOldFirmware = 64;

class OusterModel final : public LidarModel {
 public:
  explicit OusterModel(const Unit& unit)
      : unit_(unit), beams_(beams_of(unit)), format_(format_of(unit)), traits_(traits_of(unit)) {}

  [[nodiscard]] const LidarTraits& traits() const noexcept override { return traits_; }

  /// Turned so that a frame begins with a tenth of a second, as phase lock does it, but for a part of a
  /// packet: the columns' times go on from the packet's moment.
  void aim(std::int64_t utc_ns, std::span<Shot> shots) const noexcept override {
    for (std::size_t k = 0; k < kColumnsPerPacket; ++k) {
      const double turn =
          static_cast<double>(first_column(utc_ns) + k) / static_cast<double>(unit_.columns_per_turn);
      // Counter-clockwise in the lidar frame, whose x axis points to the connector, backwards.
      const double encoder_rad = 2.0 * std::numbers::pi * (1.0 - turn);
      const Eigen::Vector3d origin_m(-1e-3 * unit_.beam_origin_mm * std::cos(encoder_rad),
                                     -1e-3 * unit_.beam_origin_mm * std::sin(encoder_rad),
                                     1e-3 * unit_.lift_mm);
      for (std::size_t i = 0; i < beams_.size(); ++i) {
        shots[k * beams_.size() + i] = {
            .after_ns = static_cast<std::int64_t>(k) * column_ns(),
            .azimuth_deg = std::fmod(180.0 + 360.0 * turn + beams_[i].azimuth_deg + 360.0, 360.0),
            .elevation_deg = beams_[i].altitude_deg,
            .origin_m = origin_m,
            .laser = i};
      }
    }
  }

  [[nodiscard]] std::vector<std::byte> encode(std::uint64_t /*packet*/, std::int64_t utc_ns,
                                              std::span<const Echo> echoes) const override {
    std::vector<Echo> rows(kColumnsPerPacket * format_.rows);
    for (std::size_t k = 0; k < kColumnsPerPacket; ++k) {
      for (std::size_t i = 0; i < beams_.size(); ++i) {
        Echo echo = echoes[k * beams_.size() + i];
        // The sensor counts from the axis on.
        if (echo.range_m > 0.0) echo.range_m += 1e-3 * unit_.beam_origin_mm;
        rows[k * format_.rows + row_of(i)] = echo;
      }
    }
    return lidar_packet(format_,
                        {.frame_id = static_cast<std::uint32_t>(utc_ns / kOusterTurn_ns) & 0xFFFF,
                         .first_column = first_column(utc_ns),
                         .utc_ns = utc_ns,
                         .column_ns = column_ns()},
                        rows);
  }

  [[nodiscard]] std::vector<std::byte> encode_telemetry(const GpsFix& fix) const override {
    return unit_.nmea_imu ? nmea_imu_packet(format_, fix.utc_ns) : imu_packet(fix.utc_ns);
  }

  [[nodiscard]] std::optional<CalibrationFile> calibration() const override {
    return CalibrationFile{.name = "metadata.json", .text = unit_.flat_metadata ? flat() : nested()};
  }

 private:
  static PacketFormat format_of(const Unit& unit) {
    const bool fusa = unit.profile == ouster::Profile::low_rate_dual_fusa;
    return {.profile = unit.profile,
            .fusa_header = fusa,
            .checksum = !fusa,
            .rows = unit.sixty_four_rows ? kRowsOfOldFirmware : unit.beams,
            .columns_per_turn = unit.columns_per_turn,
            .serial_number = kSerialNumber,
            .init_id = kInitId};
  }
  static LidarTraits traits_of(const Unit& unit) {
    return {
        .name = unit.name,
        .data_port = kLidarPort,
        .telemetry_port = kImuPort,
        .packet_ns = kOusterTurn_ns / static_cast<std::int64_t>(unit.columns_per_turn / kColumnsPerPacket),
        .shots_per_packet = kColumnsPerPacket * unit.beams,
        .min_range_m = unit.min_range_m,
        .max_range_m = unit.max_range_m,
        .range_sigma_m = unit.range_sigma_m};
  }

  [[nodiscard]] std::int64_t column_ns() const noexcept {
    return traits_.packet_ns / static_cast<std::int64_t>(kColumnsPerPacket);
  }
  [[nodiscard]] std::size_t first_column(std::int64_t utc_ns) const noexcept {
    return static_cast<std::size_t>(utc_ns % kOusterTurn_ns / traits_.packet_ns) * kColumnsPerPacket;
  }
  /// Old firmware leaves three of four rows empty for 16 beams (suffix A0 of the product line).
  [[nodiscard]] std::size_t row_of(std::size_t beam) const noexcept {
    return unit_.sixty_four_rows ? 4 * beam + 3 : beam;
  }

  [[nodiscard]] std::string angles(double Beam::*angle) const {
    std::vector<double> values(format_.rows, 0.0);
    for (std::size_t i = 0; i < beams_.size(); ++i) values[row_of(i)] = beams_[i].*angle;
    return fmt::format("[{}]", fmt::join(values, ", "));
  }
  [[nodiscard]] std::string lidar_to_sensor() const {
    return fmt::format("[-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, {}, 0, 0, 0, 1]", unit_.lift_mm);
  }
  [[nodiscard]] std::string data_format() const {
    return fmt::format(R"("pixels_per_column": {}, "columns_per_packet": {}, "columns_per_frame": {},
    "column_window": [0, {}], "udp_profile_lidar": "{}")",
                       unit_.beams, kColumnsPerPacket, unit_.columns_per_turn, unit_.columns_per_turn - 1,
                       name_of(unit_.profile));
  }

  [[nodiscard]] std::string flat() const {
    return fmt::format(R"({{
  "prod_line": "{}", "prod_sn": "{}", "build_rev": "{}", "initialization_id": {},
  "lidar_mode": "{}x10",
  "beam_altitude_angles": {},
  "beam_azimuth_angles": {},
  "lidar_origin_to_beam_origin_mm": {},
  "lidar_to_sensor_transform": {},
  "data_format": {{{}}}
}}
)",
                       unit_.prod_line, kSerialNumber, unit_.firmware, kInitId, unit_.columns_per_turn,
                       angles(&Beam::altitude_deg), angles(&Beam::azimuth_deg), unit_.beam_origin_mm,
                       lidar_to_sensor(), data_format());
  }

  [[nodiscard]] std::string nested() const {
    return fmt::format(R"({{
  "sensor_info": {{"prod_line": "{}", "prod_sn": "{}", "image_rev": "ousteros-image-prod-{}", "initialization_id": {}}},
  "config_params": {{"lidar_mode": "{}x10", "timestamp_mode": "TIME_FROM_PTP_1588"}},
  "beam_intrinsics": {{
    "beam_altitude_angles": {},
    "beam_azimuth_angles": {},
    "lidar_origin_to_beam_origin_mm": {},
    "beam_to_lidar_transform": [1, 0, 0, {}, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
  }},
  "lidar_intrinsics": {{"lidar_to_sensor_transform": {}}},
  "lidar_data_format": {{{}, "fps": 10, "header_type": "{}"}}
}}
)",
                       unit_.prod_line, kSerialNumber, unit_.firmware, kInitId, unit_.columns_per_turn,
                       angles(&Beam::altitude_deg), angles(&Beam::azimuth_deg), unit_.beam_origin_mm,
                       unit_.beam_origin_mm, lidar_to_sensor(), data_format(),
                       format_.fusa_header ? "FUSA" : "STANDARD");
  }

  Unit unit_;
  std::vector<Beam> beams_;
  PacketFormat format_;
  LidarTraits traits_;
};

}  // namespace

std::unique_ptr<LidarModel> make_ouster(std::string_view name) {
  const auto all = units();
  const auto found = std::ranges::find(all, name, &Unit::name);
  if (found == all.end()) throw std::invalid_argument(fmt::format("no unit of '{}'", name));
  return std::make_unique<OusterModel>(*found);
}

}  // namespace landfix::tools::simulator
