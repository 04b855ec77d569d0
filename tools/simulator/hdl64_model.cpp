#include "tools/simulator/hdl64_model.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string_view>

#include "tools/simulator/hdl64_unit.hpp"
#include "tools/simulator/velodyne_packets.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr std::size_t kLasersPerBlock = 32;
constexpr std::size_t kHdl64ShotsPerPacket = velodyne::kBlocks * kLasersPerBlock;
constexpr double kHdl64RangeUnit_m = 0.002;

// S2 and S3: lasers k of both blocks fire together, 48 us for all; S1: a block every 32 us.
constexpr std::int64_t kFiring_ns = 48'000;
constexpr std::int64_t kS1Block_ns = 32'000;
constexpr std::int64_t kS1Laser_ns = 1'000;
/// All azimuths of a recorded S1 are multiples of this (test/real/hdl64_real_test.cpp): its encoder has 4000
/// steps a turn. No document says where in a step it counts; a unit's rotational corrections are measured by
/// its own encoder, so that they hold for the middle of the step.
constexpr double kS1Step_deg = 0.09;

constexpr LidarTraits traits_of(std::string_view name, std::int64_t packet_ns) noexcept {
  return {.name = name,
          .data_port = velodyne::kDataPort,
          .telemetry_port = 0,
          .packet_ns = packet_ns,
          .shots_per_packet = kHdl64ShotsPerPacket,
          .min_range_m = 2.0,  // the corrections leave nothing to measure of less
          .max_range_m = 120.0,
          .range_sigma_m = 0.01};
}
constexpr LidarTraits kS1Traits = traits_of("hdl64s1", velodyne::kBlocks* kS1Block_ns);
constexpr LidarTraits kS2Traits = traits_of("hdl64s2", velodyne::kBlocks / 2 * kFiring_ns);
constexpr LidarTraits kS3Traits = traits_of("hdl64s3", velodyne::kBlocks / 2 * kFiring_ns);

/// Within a firing: four lasers in quick succession, then a pause.
std::int64_t firing_ns(std::size_t slot) noexcept {
  constexpr std::array<std::int64_t, 4> kOfFour_ns{0, 1'260, 2'460, 3'660};
  return static_cast<std::int64_t>(slot / 4) * 6'000 + kOfFour_ns[slot % 4];
}

struct Status {
  std::uint8_t type;
  std::uint8_t value;
};

/// Time and date, then the unit's own bytes, one a packet.
Status status_of(std::uint64_t packet, std::int64_t utc_ns, std::span<const std::uint8_t> set, bool is_s3) {
  constexpr std::string_view kTypes = "HMSDNYGTV1234567";
  const std::size_t place = packet % kTypes.size();
  const char type = kTypes[place];
  if (place >= 9) {
    const std::size_t cycle = packet / kTypes.size() % 260;
    const std::size_t at = cycle * 7 + place - 9;
    const bool warns = is_s3 && type == '1' && cycle >= 4 && cycle % 4 == 0 && cycle < 256;
    if (warns) return {'W', 0x60};  // pulse and satellites are there
    // The S3 names what the tail holds: speed, field of view, returns, power.
    if (is_s3 && at >= 1799 && at < 1805) {
      constexpr std::array<std::uint8_t, 6> kNames{0xFE, 0xFF, 0xFC, 0xFD, 0xFA, 0xFB};
      return {kNames[at - 1799], set[at]};
    }
    if (is_s3 && at == 1815) return {0xF9, set[at]};
    if (is_s3 && at == 1817) return {0xF8, set[at]};
    return {static_cast<std::uint8_t>(type), set[at]};
  }
  using std::chrono::days;
  using std::chrono::floor;
  const std::chrono::sys_seconds now{std::chrono::seconds(utc_ns / 1'000'000'000)};
  const std::chrono::year_month_day date{floor<days>(now)};
  const std::chrono::hh_mm_ss time{now - floor<days>(now)};
  const std::array<long, 9> values{time.hours().count(),
                                   time.minutes().count(),
                                   time.seconds().count(),
                                   static_cast<long>(static_cast<unsigned>(date.day())),
                                   static_cast<long>(static_cast<unsigned>(date.month())),
                                   static_cast<int>(date.year()) - 2000,
                                   'A',
                                   38,
                                   is_s3 ? 0x50 : 0x47};
  return {static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(values[place])};
}

class Hdl64Model final : public LidarModel {
 public:
  explicit Hdl64Model(Hdl64Variant variant)
      : variant_(variant),
        set_(hdl64_set(variant == Hdl64Variant::s3 ? Hdl64SetKind::s3 : Hdl64SetKind::s2)) {}

  [[nodiscard]] const LidarTraits& traits() const noexcept override {
    switch (variant_) {
      case Hdl64Variant::s1:
        return kS1Traits;
      case Hdl64Variant::s2:
        return kS2Traits;
      case Hdl64Variant::s3:
        break;
    }
    return kS3Traits;
  }

  void aim(std::int64_t utc_ns, std::span<Shot> shots) const noexcept override {
    for (std::size_t i = 0; i < kHdl64ShotsPerPacket; ++i) {
      const std::size_t block = i / kLasersPerBlock;
      const std::size_t slot = i % kLasersPerBlock;
      const Hdl64UnitLaser& laser = unit_[laser_of(block, slot)];
      const std::int64_t after_ns =
          block_ns(block) +
          (variant_ == Hdl64Variant::s1 ? static_cast<std::int64_t>(slot) * kS1Laser_ns : firing_ns(slot));
      const double azimuth_deg = rotor_angle_deg(utc_ns + after_ns) - 0.01 * laser.rotation_centideg;
      const double azimuth_rad = azimuth_deg * std::numbers::pi / 180.0;
      // Beside the axis, square to the beam.
      const double left_m = 1e-3 * laser.left_mm;
      shots[i] = {.after_ns = after_ns,
                  .azimuth_deg = azimuth_deg,
                  .elevation_deg = 0.01 * laser.elevation_centideg,
                  .origin_m = {left_m * std::sin(azimuth_rad), left_m * std::cos(azimuth_rad),
                               1e-3 * laser.height_mm},
                  .laser = laser_of(block, slot)};
    }
  }

  [[nodiscard]] std::vector<std::byte> encode(std::uint64_t packet, std::int64_t utc_ns,
                                              std::span<const Echo> echoes) const override {
    velodyne::DataPacket data;
    for (std::size_t block = 0; block < velodyne::kBlocks; ++block) {
      data.put_block(block, is_upper(block) ? velodyne::kUpperBank : velodyne::kLowerBank,
                     azimuth_centideg(utc_ns + block_ns(block)));
      for (std::size_t slot = 0; slot < kLasersPerBlock; ++slot) {
        Echo echo = echoes[block * kLasersPerBlock + slot];
        if (echo.range_m != 0.0) echo.range_m -= 1e-3 * unit_[laser_of(block, slot)].range_mm;
        data.put_return(block, slot, echo, kHdl64RangeUnit_m);
      }
    }
    put_tail(packet, utc_ns, data);
    return data.take();
  }

  [[nodiscard]] std::optional<CalibrationFile> calibration() const override {
    if (variant_ == Hdl64Variant::s3) return CalibrationFile{"hdl64.yaml", hdl64_yaml()};
    return CalibrationFile{"db.xml", hdl64_db_xml()};
  }

 private:
  [[nodiscard]] std::uint16_t azimuth_centideg(std::int64_t utc_ns) const noexcept {
    if (variant_ != Hdl64Variant::s1) return rotor_angle_centideg(utc_ns);
    return static_cast<std::uint16_t>(std::lround(rotor_angle_deg(utc_ns) / kS1Step_deg) % 4000 * 9);
  }
  [[nodiscard]] bool is_upper(std::size_t block) const noexcept {
    return variant_ == Hdl64Variant::s1 ? block % 4 != 0 : block % 2 == 0;
  }
  [[nodiscard]] std::size_t laser_of(std::size_t block, std::size_t slot) const noexcept {
    return is_upper(block) ? slot : kLasersPerBlock + slot;
  }
  [[nodiscard]] std::int64_t block_ns(std::size_t block) const noexcept {
    return variant_ == Hdl64Variant::s1 ? static_cast<std::int64_t>(block) * kS1Block_ns
                                        : static_cast<std::int64_t>(block / 2) * kFiring_ns;
  }
  void put_tail(std::uint64_t packet, std::int64_t utc_ns, velodyne::DataPacket& data) const {
    if (variant_ == Hdl64Variant::s1) {
      data.put_text(packet % 2 == 0 ? "Q DegC" : "!-v25c");
      return;
    }
    const std::int64_t end_utc_ns = utc_ns + traits().packet_ns;
    const Status status = status_of(packet, end_utc_ns, set_, variant_ == Hdl64Variant::s3);
    data.put_time(end_utc_ns);
    data.put_factory_bytes(status.type, status.value);
  }

  Hdl64Variant variant_;
  std::array<Hdl64UnitLaser, 64> unit_ = hdl64_unit();
  std::vector<std::uint8_t> set_;
};

}  // namespace

std::unique_ptr<LidarModel> make_hdl64(Hdl64Variant variant) { return std::make_unique<Hdl64Model>(variant); }

}  // namespace landfix::tools::simulator
