#include "tools/simulator/velodyne32_model.hpp"

#include "tools/simulator/velodyne_packets.hpp"
#include "tools/simulator/velodyne_tables.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr std::size_t kLasers = 32;

struct Sensor {
  LidarTraits traits;
  std::array<velodyne::Laser, kLasers> lasers;
  std::size_t lasers_at_once;
  std::int64_t firing_ns;    ///< from one firing of a laser, or of a pair, to the next
  std::int64_t sequence_ns;  ///< of all lasers, and a recharge
  double range_unit_m;
  std::uint8_t product;
};

constexpr LidarTraits traits(std::string_view name, std::int64_t sequence_ns, double max_range_m,
                             double range_sigma_m) noexcept {
  return {.name = name,
          .data_port = velodyne::kDataPort,
          .telemetry_port = velodyne::kPositionPort,
          .packet_ns = static_cast<std::int64_t>(velodyne::kBlocks) * sequence_ns,
          .shots_per_packet = velodyne::kBlocks * kLasers,
          .min_range_m = 1.0,
          .max_range_m = max_range_m,
          .range_sigma_m = range_sigma_m};
}

/// Two lasers fire together; +-3 cm, read as 3 sigma.
constexpr Sensor kVlp32c{.traits = traits("vlp32c", 55'296, 200.0, 0.01),
                         .lasers = velodyne::kVlp32c,
                         .lasers_at_once = 2,
                         .firing_ns = 2'304,
                         .sequence_ns = 55'296,
                         .range_unit_m = 0.004,
                         .product = 0x28};
/// Its lasers fire singly; +-2 cm, read as 3 sigma.
constexpr Sensor kHdl32e{.traits = traits("hdl32e", 46'080, 100.0, 0.007),
                         .lasers = velodyne::kHdl32e,
                         .lasers_at_once = 1,
                         .firing_ns = 1'152,
                         .sequence_ns = 46'080,
                         .range_unit_m = 0.002,
                         .product = 0x21};

class Velodyne32Model final : public LidarModel {
 public:
  explicit Velodyne32Model(const Sensor& sensor) noexcept : sensor_(sensor) {}

  [[nodiscard]] const LidarTraits& traits() const noexcept override { return sensor_.traits; }

  void aim(std::int64_t utc_ns, std::span<Shot> shots) const noexcept override {
    for (std::size_t i = 0; i < sensor_.traits.shots_per_packet; ++i) {
      const velodyne::Laser& laser = sensor_.lasers[i % kLasers];
      const std::size_t firing = i % kLasers / sensor_.lasers_at_once;
      const auto after_ns = static_cast<std::int64_t>(i / kLasers) * sensor_.sequence_ns +
                            static_cast<std::int64_t>(firing) * sensor_.firing_ns;
      shots[i] = {.after_ns = after_ns,
                  .azimuth_deg = rotor_angle_deg(utc_ns + after_ns) + laser.azimuth_offset_deg,
                  .elevation_deg = laser.elevation_deg};
    }
  }

  [[nodiscard]] std::vector<std::byte> encode(std::uint64_t /*packet*/, std::int64_t utc_ns,
                                              std::span<const Echo> echoes) const override {
    velodyne::DataPacket packet;
    for (std::size_t block = 0; block < velodyne::kBlocks; ++block) {
      const std::int64_t block_utc_ns = utc_ns + static_cast<std::int64_t>(block) * sensor_.sequence_ns;
      packet.put_block(block, velodyne::kUpperBank, rotor_angle_centideg(block_utc_ns));
      for (std::size_t slot = 0; slot < kLasers; ++slot) {
        packet.put_return(block, slot, echoes[block * kLasers + slot], sensor_.range_unit_m);
      }
    }
    packet.put_time(utc_ns);
    packet.put_factory_bytes(velodyne::kStrongestReturn, sensor_.product);
    return packet.take();
  }

  [[nodiscard]] std::vector<std::byte> encode_telemetry(const GpsFix& fix) const override {
    return velodyne::position_packet(fix);
  }

 private:
  const Sensor& sensor_;
};

}  // namespace

std::unique_ptr<LidarModel> make_velodyne32(Velodyne32Variant variant) {
  return std::make_unique<Velodyne32Model>(variant == Velodyne32Variant::vlp32c ? kVlp32c : kHdl32e);
}

}  // namespace landfix::tools::simulator
