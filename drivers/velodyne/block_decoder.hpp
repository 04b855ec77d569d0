// The sensors whose every block holds whole firing sequences: VLP-16, Puck LITE and Hi-Res, VLP-32C and
// HDL-32E (VLP-16 User Manual 63-9243 Rev D, chapter 9, VLP-32C User Manual 63-9325 Rev B, and the
// HDL-32E's). They differ in data alone.
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
#include "drivers/velodyne/block_layout.hpp"
#include "drivers/velodyne/position_packet.hpp"
#include "drivers/velodyne/spin_rate.hpp"
#include "drivers/velodyne/wire.hpp"

namespace landfix::drivers::velodyne {

class BlockDecoder {
 public:
  /// `beams`: in the order of the laser ids, `layout.lasers` of them.
  BlockDecoder(const BlockLayout& layout, std::span<const Beam> beams,
               const DecoderOptions& options) noexcept;

  [[nodiscard]] DecodeResult decode(const Packet& packet, SweepPair& sweeps) noexcept;
  [[nodiscard]] bool flush(SweepPair& sweeps) noexcept { return builder_.flush(sweeps); }
  [[nodiscard]] const StreamCounters& counters() const noexcept { return builder_.counters(); }

  /// Where the receiver at the sensor says it is, by the latest position packet.
  [[nodiscard]] const std::optional<PositionFix>& position() const noexcept { return position_; }

 private:
  /// What a packet says, once it is known to be sound.
  struct Header {
    std::array<std::uint16_t, kBlocks> firing_azimuth_centideg{};  ///< one a firing: a dual pair counts once
    std::size_t firings = 0;
    std::size_t returns = 1;  ///< blocks a firing
    std::uint32_t top_of_hour_us = 0;
  };
  [[nodiscard]] DecodeStatus validate(const WirePacket& wire, Header& header) const noexcept;
  [[nodiscard]] DecodeStatus begin_packet(const Header& header, std::int64_t first_firing_ns,
                                          std::int64_t receive_utc_ns, SweepPair& sweeps) noexcept;

  BlockProjector projector_;
  RangeGate gate_;
  SweepBuilder builder_;
  SpinRate spin_rate_;
  std::optional<PositionFix> position_;
  BlockLayout layout_;
  bool firing_time_azimuth_;
};
static_assert(PacketDecoder<BlockDecoder>);

}  // namespace landfix::drivers::velodyne
