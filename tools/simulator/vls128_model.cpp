#include "tools/simulator/vls128_model.hpp"

#include <array>

#include "tools/simulator/velodyne_packets.hpp"
#include "tools/simulator/velodyne_tables.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr std::size_t kLasers = 128;
constexpr std::size_t kBanks = 4;
constexpr std::size_t kBankLasers = kLasers / kBanks;
constexpr std::size_t kSequences = velodyne::kBlocks / kBanks;
constexpr std::array<std::uint16_t, kBanks> kBankFlags{0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};

/// Eight lasers fire in a slot; after 64 lasers one slot is for maintenance, after all of them three.
constexpr double kSlot_ns = 2'763.9;
constexpr double kSequence_ns = 20.0 * kSlot_ns;
constexpr std::int64_t kStampAfterFirstFiring_ns = 8'700;
constexpr double kVls128RangeUnit_m = 0.004;
constexpr std::uint8_t kProduct = 0xA1;

constexpr LidarTraits traits(std::string_view name) noexcept {
  return {.name = name,
          .data_port = velodyne::kDataPort,
          .telemetry_port = velodyne::kPositionPort,
          .packet_ns = static_cast<std::int64_t>(static_cast<double>(kSequences) * kSequence_ns),
          .shots_per_packet = kSequences * kLasers,
          .min_range_m = 1.0,
          .max_range_m = 245.0,
          .range_sigma_m = 0.01,  // the data sheet's +-3 cm, read as 3 sigma
          .elevation_sigma_deg = velodyne::kElevationSigma_deg};
}
constexpr LidarTraits kVls128Traits = traits("vls128");
constexpr LidarTraits kAlphaPrimeTraits = traits("vls128ap");

[[nodiscard]] constexpr std::int64_t sequence_after_ns(std::size_t sequence) noexcept {
  return static_cast<std::int64_t>(static_cast<double>(sequence) * kSequence_ns);
}

class Vls128Model final : public LidarModel {
 public:
  explicit Vls128Model(Vls128Variant variant) noexcept : variant_(variant) {}

  [[nodiscard]] const LidarTraits& traits() const noexcept override {
    return variant_ == Vls128Variant::vls128 ? kVls128Traits : kAlphaPrimeTraits;
  }

  void aim(std::int64_t utc_ns, std::span<Shot> shots) const noexcept override {
    for (std::size_t i = 0; i < kSequences * kLasers; ++i) {
      const std::size_t id = i % kLasers;
      const std::size_t slot = id / 8 + (id < 64 ? 0 : 1);
      const auto after_ns =
          sequence_after_ns(i / kLasers) + static_cast<std::int64_t>(static_cast<double>(slot) * kSlot_ns);
      shots[i] = {
          .after_ns = after_ns,
          .azimuth_deg = rotor_angle_deg(utc_ns + after_ns) + velodyne::kVls128[id].azimuth_offset_deg,
          .elevation_deg = velodyne::kVls128[id].elevation_deg,
          .laser = id};
    }
  }

  [[nodiscard]] std::vector<std::byte> encode(std::uint64_t /*packet*/, std::int64_t utc_ns,
                                              std::span<const Echo> echoes) const override {
    velodyne::DataPacket packet;
    for (std::size_t block = 0; block < velodyne::kBlocks; ++block) {
      const std::int64_t sequence_utc_ns = utc_ns + sequence_after_ns(block / kBanks);
      packet.put_block(block, kBankFlags[block % kBanks], rotor_angle_centideg(sequence_utc_ns));
      for (std::size_t slot = 0; slot < kBankLasers; ++slot) {
        packet.put_return(block, slot, echoes[block * kBankLasers + slot], kVls128RangeUnit_m);
      }
    }
    packet.put_time(utc_ns + kStampAfterFirstFiring_ns);
    packet.put_factory_bytes(velodyne::kStrongestReturn, kProduct);
    return packet.take();
  }

  [[nodiscard]] std::vector<std::byte> encode_telemetry(const GpsFix& fix) const override {
    return velodyne::position_packet(fix);
  }

 private:
  Vls128Variant variant_;
};

}  // namespace

std::unique_ptr<LidarModel> make_vls128(Vls128Variant variant) {
  return std::make_unique<Vls128Model>(variant);
}

}  // namespace landfix::tools::simulator
