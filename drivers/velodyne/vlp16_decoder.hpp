// VLP-16, Puck LITE and Puck Hi-Res: 16 lasers, two firing sequences a block (VLP-16 User Manual 63-9243
// Rev D, chapter 9).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/beam.hpp"
#include "drivers/block_projector.hpp"
#include "drivers/decoder.hpp"
#include "drivers/decoder_options.hpp"
#include "drivers/sweep_builder.hpp"
#include "drivers/velodyne/spin_rate.hpp"
#include "drivers/velodyne/wire.hpp"

namespace landfix::drivers::velodyne {

inline constexpr std::size_t kVlp16Lasers = 16;

class Vlp16Decoder {
 public:
  /// `beams`: in the order of the laser ids. `product`: the byte that names the model, 0x22 or 0x24.
  Vlp16Decoder(std::span<const Beam, kVlp16Lasers> beams, std::uint8_t product,
               const DecoderOptions& options) noexcept;

  [[nodiscard]] DecodeResult decode(const Packet& packet, SweepPair& sweeps) noexcept;
  [[nodiscard]] bool flush(SweepPair& sweeps) noexcept { return builder_.flush(sweeps); }
  [[nodiscard]] const StreamCounters& counters() const noexcept { return builder_.counters(); }

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
  std::uint8_t product_;
  bool firing_time_azimuth_;
};
static_assert(PacketDecoder<Vlp16Decoder>);

}  // namespace landfix::drivers::velodyne
