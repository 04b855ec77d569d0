// VLS-128 and Alpha Prime: 128 lasers in four banks of 32, a block a bank (VLS-128 User Manual 63-9483 Rev
// A).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/beam.hpp"
#include "drivers/block_projector.hpp"
#include "drivers/decoder.hpp"
#include "drivers/decoder_options.hpp"
#include "drivers/sweep_builder.hpp"
#include "drivers/velodyne/position_packet.hpp"
#include "drivers/velodyne/slot_time.hpp"
#include "drivers/velodyne/spin_rate.hpp"
#include "drivers/velodyne/wire.hpp"

namespace landfix::drivers::velodyne {

inline constexpr std::size_t kVls128Lasers = 128;
inline constexpr std::size_t kBanks = kBankFlags.size();

class Vls128Decoder {
 public:
  /// `beams`: in the order of the laser ids; their firing times are counted in slots, which are measured.
  Vls128Decoder(std::span<const Beam, kVls128Lasers> beams, const DecoderOptions& options) noexcept;

  [[nodiscard]] DecodeResult decode(const Packet& packet, SweepPair& sweeps) noexcept;
  [[nodiscard]] bool flush(SweepPair& sweeps) noexcept { return builder_.flush(sweeps); }
  [[nodiscard]] const StreamCounters& counters() const noexcept { return builder_.counters(); }

  /// Where the receiver at the sensor says it is, by the latest position packet.
  [[nodiscard]] const std::optional<PositionFix>& position() const noexcept { return position_; }

  /// The firing slot as it has been measured so far.
  [[nodiscard]] double slot_us() const noexcept { return slot_.us(); }

 private:
  /// What a packet says, once it is known to be sound. A firing sequence is one block a bank and return.
  struct Header {
    std::array<std::uint16_t, kBlocks / kBanks> azimuth_centideg{};  ///< one a sequence
    std::size_t sequences = 0;
    std::size_t blocks_a_bank = 1;  ///< in a sequence
    std::size_t returns = 1;        ///< of those, the ones that are returns
    std::uint32_t top_of_hour_us = 0;
  };
  [[nodiscard]] DecodeStatus validate(const WirePacket& wire, Header& header) const noexcept;
  void measure(const Header& header, std::int64_t first_firing_ns) noexcept;
  void fit_projectors() noexcept;

  SlotTime slot_;
  double projected_slot_us_;                                       ///< that the projectors were made for
  std::array<std::array<FiringSlot, kBlockSlots>, kBanks> slots_;  ///< times in slots, not seconds
  std::array<BlockProjector, kBanks> projectors_;
  RangeGate gate_;
  SweepBuilder builder_;
  SpinRate spin_rate_;
  std::optional<PositionFix> position_;
  std::int64_t last_firing_ns_ = 0;
  std::optional<std::uint16_t> last_azimuth_centideg_;
  bool firing_time_azimuth_;
};
static_assert(PacketDecoder<Vls128Decoder>);

}  // namespace landfix::drivers::velodyne
