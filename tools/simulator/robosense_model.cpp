#include "tools/simulator/robosense_model.hpp"

#include <cmath>
#include <numbers>
#include <span>

#include <fmt/format.h>

#include "tools/simulator/robosense_packets.hpp"
#include "tools/simulator/robosense_tables.hpp"

namespace landfix::tools::simulator {
namespace {

using robosense::Angles;
using robosense::DataPacket;
using robosense::DeviceInfoPacket;
using robosense::Family;
using robosense::kBlocks;
using robosense::kSlots;

struct Unit {
  Family family{};
  std::span<const Angles> angles;
  double angle_unit_deg = 0.0;
  std::span<const int> firing_ns;
  std::int64_t period_ns = 0;  ///< from firing to firing
  double range_unit_m = 0.0;
  double lens_forward_m = 0.0;
  std::size_t vertical_at = 0;  ///< in the device information
  std::size_t horizontal_at = 0;
  LidarTraits traits;

  /// One of 32 lasers, two of 16.
  [[nodiscard]] std::int64_t block_ns() const noexcept {
    return period_ns * static_cast<std::int64_t>(kSlots / angles.size());
  }
};

constexpr LidarTraits traits_of(std::string_view name, std::int64_t packet_ns, double min_range_m,
                                double max_range_m, double range_sigma_m) noexcept {
  return {.name = name,
          .data_port = robosense::kDataPort,
          .telemetry_port = robosense::kDeviceInfoPort,
          .packet_ns = packet_ns,
          .shots_per_packet = kBlocks * kSlots,
          .min_range_m = min_range_m,
          .max_range_m = max_range_m,
          .range_sigma_m = range_sigma_m};
}

/// Ranges in 0.5 cm: today's firmware. Noise: the data sheet's +-3 cm, read as 3 sigma.
constexpr Unit kRs32{.family = Family::rs_lidar,
                     .angles = robosense::kRs32Angles,
                     .angle_unit_deg = 0.001,
                     .firing_ns = robosense::kRs32Firing_ns,
                     .period_ns = 55'520,
                     .range_unit_m = 0.005,
                     .lens_forward_m = 0.03997,
                     .vertical_at = 468,
                     .horizontal_at = 564,
                     .traits = traits_of("rs32", kBlocks * 55'520, 0.4, 200.0, 0.01)};
constexpr Unit kRs16{.family = Family::rs_lidar,
                     .angles = robosense::kRs16Angles,
                     .angle_unit_deg = 0.0001,
                     .firing_ns = robosense::kRs16Firing_ns,
                     .period_ns = 55'500,
                     .range_unit_m = 0.005,
                     .lens_forward_m = 0.03825,
                     .vertical_at = 1165,
                     .horizontal_at = 0,
                     .traits = traits_of("rs16", kBlocks * 2 * 55'500, 0.4, 150.0, 0.007)};
constexpr Unit kHelios16p{.family = Family::helios,
                          .angles = robosense::kHelios16pAngles,
                          .angle_unit_deg = 0.01,
                          .firing_ns = robosense::kHelios16pFiring_ns,
                          .period_ns = 55'560,
                          .range_unit_m = 0.0025,
                          .lens_forward_m = 0.03498,
                          .vertical_at = 468,
                          .horizontal_at = 564,
                          .traits = traits_of("helios16p", kBlocks * 2 * 55'560, 0.2, 150.0, 0.007)};

class RobosenseModel final : public LidarModel {
 public:
  explicit RobosenseModel(const Unit& unit) noexcept : unit_(unit) {}

  [[nodiscard]] const LidarTraits& traits() const noexcept override { return unit_.traits; }

  void aim(std::int64_t utc_ns, std::span<Shot> shots) const noexcept override {
    const std::size_t lasers = unit_.angles.size();
    for (std::size_t i = 0; i < kBlocks * kSlots; ++i) {
      const std::size_t laser = i % lasers;
      const auto after_ns = static_cast<std::int64_t>(i / lasers) * unit_.period_ns + unit_.firing_ns[laser];
      const double rotor_deg = rotor_angle_deg(utc_ns + after_ns);
      const double rotor_rad = rotor_deg * std::numbers::pi / 180.0;
      shots[i] = {.after_ns = after_ns,
                  .azimuth_deg = rotor_deg + unit_.angles[laser].horizontal * unit_.angle_unit_deg,
                  .elevation_deg = unit_.angles[laser].vertical * unit_.angle_unit_deg,
                  .origin_m = {unit_.lens_forward_m * std::cos(rotor_rad),
                               -unit_.lens_forward_m * std::sin(rotor_rad), 0.0},
                  .laser = laser};
    }
  }

  [[nodiscard]] std::vector<std::byte> encode(std::uint64_t /*packet*/, std::int64_t utc_ns,
                                              std::span<const Echo> echoes) const override {
    DataPacket packet(unit_.family);
    for (std::size_t block = 0; block < kBlocks; ++block) {
      const auto block_utc_ns = utc_ns + static_cast<std::int64_t>(block) * unit_.block_ns();
      packet.put_block(block, rotor_angle_centideg(block_utc_ns));
      for (std::size_t slot = 0; slot < kSlots; ++slot) {
        packet.put_return(block, slot, echoes[block * kSlots + slot], unit_.range_unit_m);
      }
    }
    packet.put_time(utc_ns);
    return packet.take();
  }

  [[nodiscard]] std::vector<std::byte> encode_telemetry(const GpsFix& fix) const override {
    DeviceInfoPacket packet(unit_.family, fix.utc_ns);
    for (std::size_t i = 0; i < unit_.angles.size(); ++i) {
      const Angles& angles = unit_.angles[i];
      if (unit_.horizontal_at == 0) {
        packet.put_magnitude(unit_.vertical_at + 3 * i, static_cast<unsigned>(std::abs(angles.vertical)));
      } else {
        packet.put_angle(unit_.vertical_at + 3 * i, angles.vertical);
        packet.put_angle(unit_.horizontal_at + 3 * i, angles.horizontal);
      }
    }
    return packet.take();
  }

  [[nodiscard]] std::optional<CalibrationFile> calibration() const override {
    std::string text;
    for (const Angles& angles : unit_.angles) {
      text += fmt::format("{:.4f},{:.4f}\n", angles.vertical * unit_.angle_unit_deg,
                          angles.horizontal * unit_.angle_unit_deg);
    }
    return CalibrationFile{.name = "angle.csv", .text = std::move(text)};
  }

 private:
  const Unit& unit_;
};

}  // namespace

std::unique_ptr<LidarModel> make_robosense(RobosenseSensor sensor) {
  switch (sensor) {
    case RobosenseSensor::rs32:
      return std::make_unique<RobosenseModel>(kRs32);
    case RobosenseSensor::rs16:
      return std::make_unique<RobosenseModel>(kRs16);
    case RobosenseSensor::helios16p:
      break;
  }
  return std::make_unique<RobosenseModel>(kHelios16p);
}

}  // namespace landfix::tools::simulator
