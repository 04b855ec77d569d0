// OS0, OS1 and OS2, every UDP profile: columns of pixels at known encoder angles (Ouster's sensor
// documentation; the constants of a unit come from its metadata file).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/decoder.hpp"
#include "drivers/decoder_options.hpp"
#include "drivers/ouster/column_projector.hpp"
#include "drivers/ouster/frame_cutter.hpp"
#include "drivers/ouster/metadata.hpp"
#include "drivers/ouster/wire.hpp"

namespace landfix::drivers::ouster {

/// Columns carry the sensor's clock: UTC where PTP or NMEA sets it, else a count from power-up (or TAI, 37 s
/// ahead), which SensorClock anchors to the times of receipt. What is known of a column stays known when
/// packets are missing: its number is its azimuth, so nothing depends on the order of arrival.
class OusterDecoder {
 public:
  /// `metadata`: as parse_metadata gives it. `cut_deg` has no meaning here: frames are the sensor's own.
  OusterDecoder(const Metadata& metadata, const DecoderOptions& options) noexcept;

  [[nodiscard]] DecodeResult decode(const Packet& packet, SweepPair& sweeps) noexcept;
  [[nodiscard]] bool flush(SweepPair& sweeps) noexcept { return cutter_.flush(sweeps); }
  [[nodiscard]] const StreamCounters& counters() const noexcept { return cutter_.counters(); }

 private:
  /// What a packet says, once it is known to be sound.
  struct Header {
    std::uint32_t frame_id = 0;
    std::uint32_t init_id = 0;
    std::size_t first_column = 0;
    std::optional<std::int64_t> first_firing_ns;
    std::array<std::int64_t, kMaxColumnsPerPacket> firing_ns{};
    std::array<bool, kMaxColumnsPerPacket> valid{};
  };
  [[nodiscard]] DecodeStatus validate_frame(std::span<const std::byte> payload,
                                            Header& header) const noexcept;
  [[nodiscard]] DecodeStatus validate_columns(std::span<const std::byte> payload,
                                              Header& header) const noexcept;

  bool legacy_;
  HeaderType header_type_;
  PacketShape shape_;
  std::size_t columns_per_frame_;
  ColumnWindow window_;
  std::uint64_t serial_number_;
  ColumnProjector projector_;
  FrameCutter cutter_;
};
static_assert(PacketDecoder<OusterDecoder>);

}  // namespace landfix::drivers::ouster
