#include "tools/simulator/vlp16_model.hpp"

#include <array>

#include "tools/simulator/velodyne_packets.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr std::size_t kLasers = 16;
constexpr std::size_t kShotsPerBlock = 32;  // two firing sequences
constexpr std::size_t kShotsPerPacket = velodyne::kBlocks * kShotsPerBlock;

constexpr std::int64_t kFiring_ns = 2'304;
constexpr std::int64_t kSequence_ns = 55'296;  // 16 firings and a recharge of 18.432 us
constexpr std::int64_t kBlock_ns = 2 * kSequence_ns;
constexpr double kRangeUnit_m = 0.002;

struct Laser {
  double elevation_deg;
  double vertical_offset_mm;  ///< of the beam's origin, above the optical centre
};
using Lasers = std::array<Laser, kLasers>;

/// In the order in which they fire (table 9-1).
constexpr Lasers kPuck{{{-15.0, 11.2},
                        {1.0, -0.7},
                        {-13.0, 9.7},
                        {3.0, -2.2},
                        {-11.0, 8.1},
                        {5.0, -3.7},
                        {-9.0, 6.6},
                        {7.0, -5.1},
                        {-7.0, 5.1},
                        {9.0, -6.6},
                        {-5.0, 3.7},
                        {11.0, -8.1},
                        {-3.0, 2.2},
                        {13.0, -9.7},
                        {-1.0, 0.7},
                        {15.0, -11.2}}};
/// Two thirds of the Puck's elevations.
constexpr Lasers kHiRes{{{-10.0, 7.4},
                         {2.0 / 3.0, -0.9},
                         {-26.0 / 3.0, 6.5},
                         {2.0, -1.8},
                         {-22.0 / 3.0, 5.5},
                         {10.0 / 3.0, -2.7},
                         {-6.0, 4.6},
                         {14.0 / 3.0, -3.7},
                         {-14.0 / 3.0, 3.7},
                         {6.0, -4.6},
                         {-10.0 / 3.0, 2.7},
                         {22.0 / 3.0, -5.5},
                         {-2.0, 1.8},
                         {26.0 / 3.0, -6.5},
                         {-2.0 / 3.0, 0.9},
                         {10.0, -7.4}}};

constexpr LidarTraits kTraits{.name = "vlp16",
                              .data_port = velodyne::kDataPort,
                              .telemetry_port = velodyne::kPositionPort,
                              .packet_ns = velodyne::kBlocks * kBlock_ns,
                              .shots_per_packet = kShotsPerPacket,
                              .min_range_m = 0.5,
                              .max_range_m = 100.0,
                              .range_sigma_m = 0.01};  // the data sheet's +-3 cm, read as 3 sigma
constexpr LidarTraits hi_res_traits() noexcept {
  LidarTraits traits = kTraits;
  traits.name = "vlp16hires";
  return traits;
}
constexpr LidarTraits kHiResTraits = hi_res_traits();

class Vlp16Model final : public LidarModel {
 public:
  explicit Vlp16Model(Vlp16Variant variant) noexcept : hi_res_(variant == Vlp16Variant::hi_res) {}

  [[nodiscard]] const LidarTraits& traits() const noexcept override {
    return hi_res_ ? kHiResTraits : kTraits;
  }

  void aim(std::int64_t utc_ns, std::span<Shot> shots) const noexcept override {
    for (std::size_t i = 0; i < kShotsPerPacket; ++i) {
      const Laser& laser = (hi_res_ ? kHiRes : kPuck)[i % kLasers];
      const auto after_ns = static_cast<std::int64_t>(i / kLasers) * kSequence_ns +
                            static_cast<std::int64_t>(i % kLasers) * kFiring_ns;
      shots[i] = {.after_ns = after_ns,
                  .azimuth_deg = rotor_angle_deg(utc_ns + after_ns),
                  .elevation_deg = laser.elevation_deg,
                  .origin_m = {0.0, 0.0, 1e-3 * laser.vertical_offset_mm}};
    }
  }

  [[nodiscard]] std::vector<std::byte> encode(std::uint64_t /*packet*/, std::int64_t utc_ns,
                                              std::span<const Echo> echoes) const override {
    velodyne::DataPacket packet;
    for (std::size_t block = 0; block < velodyne::kBlocks; ++block) {
      const std::int64_t block_utc_ns = utc_ns + static_cast<std::int64_t>(block) * kBlock_ns;
      packet.put_block(block, velodyne::kUpperBank, rotor_angle_centideg(block_utc_ns));
      for (std::size_t slot = 0; slot < kShotsPerBlock; ++slot) {
        packet.put_return(block, slot, echoes[block * kShotsPerBlock + slot], kRangeUnit_m);
      }
    }
    packet.put_time(utc_ns);
    packet.put_factory_bytes(velodyne::kStrongestReturn, hi_res_ ? 0x24 : 0x22);
    return packet.take();
  }

  [[nodiscard]] std::vector<std::byte> encode_telemetry(const GpsFix& fix) const override {
    return velodyne::position_packet(fix);
  }

 private:
  bool hi_res_;
};

}  // namespace

std::unique_ptr<LidarModel> make_vlp16(Vlp16Variant variant) { return std::make_unique<Vlp16Model>(variant); }

}  // namespace landfix::tools::simulator
