// Pandar40P and Pandar64: a block is one firing of all lasers, in dual return two blocks are.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/beam.hpp"
#include "drivers/block_projector.hpp"
#include "drivers/decoder.hpp"
#include "drivers/decoder_options.hpp"
#include "drivers/hesai/pandar_layout.hpp"
#include "drivers/sweep_builder.hpp"

namespace landfix::drivers::hesai {

class PandarDecoder {
 public:
  /// `layout` outlives the decoder. `beams`: channels 1 to `layout.lasers`, best from the unit's own
  /// calibration.
  PandarDecoder(const PandarLayout& layout, std::span<const Beam> beams,
                const DecoderOptions& options) noexcept;

  [[nodiscard]] DecodeResult decode(const Packet& packet, SweepPair& sweeps) noexcept;
  [[nodiscard]] bool flush(SweepPair& sweeps) noexcept { return builder_.flush(sweeps); }
  [[nodiscard]] const StreamCounters& counters() const noexcept { return builder_.counters(); }

 private:
  /// What a packet says, once it is known to be sound.
  struct Content {
    std::array<std::uint16_t, kMaxBlocks>
        firing_azimuth_centideg{};  ///< one a firing: a dual pair counts once
    std::size_t blocks = 0;
    std::size_t firings = 0;
    std::size_t returns = 1;  ///< blocks a firing
    unsigned range_unit_mm = 0;
    unsigned motor_rpm = 0;
    std::int64_t packed_ns = 0;  ///< sensor time at which the packet was finished
    std::optional<std::uint32_t> sequence;
  };
  [[nodiscard]] DecodeStatus read(std::span<const std::byte> payload, Content& content) const noexcept;
  [[nodiscard]] DecodeStatus read_frame(std::span<const std::byte> payload, Content& content) const noexcept;
  [[nodiscard]] DecodeStatus read_tail(std::span<const std::byte> payload, Content& content) const noexcept;
  [[nodiscard]] DecodeStatus read_azimuths(std::span<const std::byte> payload,
                                           Content& content) const noexcept;
  [[nodiscard]] DecodeStatus take_gps(const Packet& packet) noexcept;
  [[nodiscard]] DecodeStatus begin_packet(const Content& content, std::int64_t first_firing_ns,
                                          std::int64_t receive_utc_ns, SweepPair& sweeps) noexcept;

  const PandarLayout* layout_;
  BlockProjector projector_;
  SweepBuilder builder_;
  DecoderOptions options_;
  std::int64_t earliest_firing_ns_;  ///< of a block, relative to its end; negative
};
static_assert(PacketDecoder<PandarDecoder>);

}  // namespace landfix::drivers::hesai
