// RS-LiDAR-32, RS-LiDAR-16, Helios-16P: one packet format, told apart by a Description.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/beam.hpp"
#include "drivers/block_projector.hpp"
#include "drivers/decoder.hpp"
#include "drivers/decoder_options.hpp"
#include "drivers/robosense/data_packet.hpp"
#include "drivers/robosense/description.hpp"
#include "drivers/robosense/device_info.hpp"
#include "drivers/robosense/rotation.hpp"
#include "drivers/sweep_builder.hpp"

namespace landfix::drivers::robosense {

/// The angles of a unit are its own: until its device information or a file has brought them, data packets
/// are answered with `uncalibrated`. There is no table to fall back on, as units of one model differ even in
/// the order of their slots.
class Decoder {
 public:
  /// `beams`: the unit's, in the order of the slots, from a file; the device information is not asked for
  /// them then. Empty: it is. `model` must outlive the decoder.
  Decoder(const Description& model, std::span<const Beam> beams, const DecoderOptions& options) noexcept;

  [[nodiscard]] DecodeResult decode(const Packet& packet, SweepPair& sweeps) noexcept;
  [[nodiscard]] bool flush(SweepPair& sweeps) noexcept { return builder_.flush(sweeps); }
  [[nodiscard]] const StreamCounters& counters() const noexcept { return builder_.counters(); }

 private:
  /// What the slots of a block are.
  enum class Layout : std::uint8_t {
    one_firing,     ///< of 32 lasers; the second return, if any, in a block of its own
    two_firings,    ///< of 16 lasers, one after the other
    close_firings,  ///< the same at twice the pace
    two_returns,    ///< of one firing of 16 lasers
  };
  /// The firings of a packet.
  struct Firings {
    std::array<std::uint16_t, kBlocks> azimuth_centideg{};
    std::array<std::int64_t, kBlocks> after_ns{};  ///< since the packet's first
    std::size_t count = 0;
    bool in_pairs = false;         ///< the second return of each is in a block of its own
    std::int64_t duration_ns = 0;  ///< until the next packet's first
    double centideg_per_us = 0.0;
  };

  [[nodiscard]] DecodeStatus take_device_info(std::span<const std::byte> payload) noexcept;
  [[nodiscard]] Layout layout_of(const DataHeader& header) const noexcept;
  [[nodiscard]] double block_period_us() const noexcept;
  [[nodiscard]] bool fits_range_unit(std::span<const std::byte> payload) const noexcept;
  [[nodiscard]] Firings firings_of(const DataHeader& header) const noexcept;
  void arrange(Layout layout) noexcept;
  void project(std::span<const std::byte> payload, const DataHeader& header, const Firings& firings,
               SweepPair& sweeps) noexcept;
  void project_firing(const std::byte* first, const std::byte* second, Block block, const RangeGate& gate,
                      Sweep& sweep) const noexcept;

  const Description* model_;
  DecoderOptions options_;
  SweepBuilder builder_;
  RotorSpeed speed_;
  UnitAngles angles_{};
  bool from_file_;
  bool calibrated_;
  bool of_another_model_ = false;  ///< by the latest device information
  std::optional<bool> dual_return_;
  bool centimetres_ = false;
  Layout layout_;
  BlockProjector projector_{{}, RangeFrom::beam_origin, ByteOrder::big};
};
static_assert(PacketDecoder<Decoder>);

}  // namespace landfix::drivers::robosense
