#include "tools/simulator/velodyne_model.hpp"

#include <array>

#include "tools/simulator/velodyne_packets.hpp"
#include "tools/simulator/velodyne_tables.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr std::size_t kShotsPerBlock = 32;  // one firing sequence of 32 lasers, or two of 16
constexpr std::size_t kShotsPerPacket = velodyne::kBlocks * kShotsPerBlock;

struct Sensor {
  LidarTraits traits;
  std::span<const velodyne::Laser> lasers;
  std::size_t lasers_at_once;
  std::int64_t firing_ns;    ///< from one firing of a laser, or of a pair, to the next
  std::int64_t sequence_ns;  ///< of all lasers, and a recharge
  double range_unit_m;
  std::uint8_t product;
};

constexpr LidarTraits traits(std::string_view name, std::int64_t packet_ns, double min_range_m,
                             double max_range_m, double range_sigma_m) noexcept {
  return {.name = name,
          .data_port = velodyne::kDataPort,
          .telemetry_port = velodyne::kPositionPort,
          .packet_ns = packet_ns,
          .shots_per_packet = kShotsPerPacket,
          .min_range_m = min_range_m,
          .max_range_m = max_range_m,
          .range_sigma_m = range_sigma_m,
          .elevation_sigma_deg = velodyne::kElevationSigma_deg};
}

/// In the order of VelodyneSensor. Accuracies are the data sheets' +-2 cm (HDL-32E) and +-3 cm, read as 3
/// sigma.
constexpr std::array kSensors{
    Sensor{.traits = traits("hdl32e", 552'960, 1.0, 100.0, 0.007),
           .lasers = velodyne::kHdl32e,
           .lasers_at_once = 1,
           .firing_ns = 1'152,
           .sequence_ns = 46'080,
           .range_unit_m = 0.002,
           .product = 0x21},
    Sensor{.traits = traits("vlp32c", 663'552, 1.0, 200.0, 0.01),
           .lasers = velodyne::kVlp32c,
           .lasers_at_once = 2,
           .firing_ns = 2'304,
           .sequence_ns = 55'296,
           .range_unit_m = 0.004,
           .product = 0x28},
    Sensor{.traits = traits("vlp16", 1'327'104, 0.5, 100.0, 0.01),
           .lasers = velodyne::kVlp16,
           .lasers_at_once = 1,
           .firing_ns = 2'304,
           .sequence_ns = 55'296,
           .range_unit_m = 0.002,
           .product = 0x22},
    Sensor{.traits = traits("vlp16hires", 1'327'104, 0.5, 100.0, 0.01),
           .lasers = velodyne::kVlp16HiRes,
           .lasers_at_once = 1,
           .firing_ns = 2'304,
           .sequence_ns = 55'296,
           .range_unit_m = 0.002,
           .product = 0x24},
};

class VelodyneModel final : public LidarModel {
 public:
  explicit VelodyneModel(const Sensor& sensor) noexcept : sensor_(sensor) {}

  [[nodiscard]] const LidarTraits& traits() const noexcept override { return sensor_.traits; }

  void aim(std::int64_t utc_ns, std::span<Shot> shots) const noexcept override {
    const std::size_t count = sensor_.lasers.size();
    for (std::size_t i = 0; i < kShotsPerPacket; ++i) {
      const velodyne::Laser& laser = sensor_.lasers[i % count];
      const std::size_t firing = i % count / sensor_.lasers_at_once;
      const auto after_ns = static_cast<std::int64_t>(i / count) * sensor_.sequence_ns +
                            static_cast<std::int64_t>(firing) * sensor_.firing_ns;
      shots[i] = {.after_ns = after_ns,
                  .azimuth_deg = rotor_angle_deg(utc_ns + after_ns) + laser.azimuth_offset_deg,
                  .elevation_deg = laser.elevation_deg,
                  .origin_m = {0.0, 0.0, 1e-3 * laser.vertical_offset_mm},
                  .laser = i % count};
    }
  }

  [[nodiscard]] std::vector<std::byte> encode(std::uint64_t /*packet*/, std::int64_t utc_ns,
                                              std::span<const Echo> echoes) const override {
    velodyne::DataPacket packet;
    const std::int64_t block_ns = sensor_.traits.packet_ns / static_cast<std::int64_t>(velodyne::kBlocks);
    for (std::size_t block = 0; block < velodyne::kBlocks; ++block) {
      const std::int64_t block_utc_ns = utc_ns + static_cast<std::int64_t>(block) * block_ns;
      packet.put_block(block, velodyne::kUpperBank, rotor_angle_centideg(block_utc_ns));
      for (std::size_t slot = 0; slot < kShotsPerBlock; ++slot) {
        packet.put_return(block, slot, echoes[block * kShotsPerBlock + slot], sensor_.range_unit_m);
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

std::unique_ptr<LidarModel> make_velodyne(VelodyneSensor sensor) {
  return std::make_unique<VelodyneModel>(kSensors[static_cast<std::size_t>(sensor)]);
}

}  // namespace landfix::tools::simulator
