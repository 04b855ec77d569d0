#include "drivers/velodyne/block_decoder.hpp"

#include <cstring>

namespace landfix::drivers::velodyne {
namespace {

std::array<FiringSlot, kBlockSlots> firing_slots(const BlockLayout& layout, std::span<const Beam> beams,
                                                 bool vertical_offsets) noexcept {
  std::array<FiringSlot, kBlockSlots> slots;
  for (std::size_t i = 0; i < kBlockSlots; ++i) {
    const Beam& beam = beams[i % layout.lasers];
    const std::size_t sequence = i / layout.lasers;
    const double sequence_us = static_cast<double>(sequence) * static_cast<double>(layout.sequence_ns) * 1e-3;
    const double time_s = (sequence_us + beam.firing_time_us) * 1e-6;
    slots[i] = {.elevation_deg = beam.elevation_deg,
                .azimuth_offset_deg = beam.azimuth_offset_deg,
                .origin_m = {.z = vertical_offsets ? beam.vertical_offset_m : 0.0},
                .turning_time_s = time_s,
                .time_s = time_s,
                .ring = beam.ring};
  }
  return slots;
}

/// How many blocks a firing has, 0 if the mode is none of the model's.
std::size_t returns_of(ReturnMode mode, std::uint16_t azimuth_0, std::uint16_t azimuth_1) noexcept {
  switch (mode) {
    case ReturnMode::strongest:
    case ReturnMode::last:
      return 1;
    case ReturnMode::dual:
      return 2;
    case ReturnMode::unknown:  // only the azimuths tell
      return azimuth_0 == azimuth_1 ? 2 : 1;
    case ReturnMode::triple:
    case ReturnMode::dual_with_confidence:
      return 0;
  }
  return 0;
}

}  // namespace

BlockDecoder::BlockDecoder(const BlockLayout& layout, std::span<const Beam> beams,
                           const DecoderOptions& options) noexcept
    : projector_(firing_slots(layout, beams, options.vertical_offsets), RangeFrom::beam_origin),
      gate_(layout.range_unit_m, options.min_range_m, options.max_range_m),
      builder_(options.cut_deg),
      layout_(layout),
      firing_time_azimuth_(options.firing_time_azimuth) {}

DecodeStatus BlockDecoder::validate(const WirePacket& wire, Header& header) const noexcept {
  std::array<std::uint16_t, kBlocks> azimuths_centideg;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    if (load_little_endian<std::uint16_t>(wire.blocks[b].flag) != kBlockFlag)
      return DecodeStatus::wrong_header;
    azimuths_centideg[b] = load_little_endian<std::uint16_t>(wire.blocks[b].azimuth_centideg);
  }
  const auto mode = static_cast<ReturnMode>(wire.return_mode);
  const bool unnamed = layout_.may_be_unnamed && mode == ReturnMode::unknown && wire.product == std::byte{0};
  if (!unnamed && wire.product != std::byte{layout_.product}) return DecodeStatus::wrong_model;
  if (!unnamed && mode == ReturnMode::unknown) return DecodeStatus::wrong_return_mode;
  header.returns = returns_of(mode, azimuths_centideg[0], azimuths_centideg[1]);
  if (header.returns == 0) return DecodeStatus::wrong_return_mode;

  header.firings = kBlocks / header.returns;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    if (azimuths_centideg[b] >= kTurnCentideg) return DecodeStatus::wrong_azimuth;
    const std::size_t firing = b / header.returns;
    header.firing_azimuth_centideg[firing] = azimuths_centideg[firing * header.returns];
    if (azimuths_centideg[b] != header.firing_azimuth_centideg[firing]) return DecodeStatus::wrong_azimuth;
  }
  if (builder_.cannot_be(std::span(header.firing_azimuth_centideg).first(header.firings))) {
    return DecodeStatus::wrong_azimuth;
  }
  header.top_of_hour_us = load_little_endian<std::uint32_t>(wire.top_of_hour_us);
  return header.top_of_hour_us <= kLatestTopOfHourUs ? DecodeStatus::decoded : DecodeStatus::wrong_time;
}

DecodeStatus BlockDecoder::begin_packet(const Header& header, std::int64_t first_firing_ns,
                                        std::int64_t receive_utc_ns, SweepPair& sweeps) noexcept {
  const auto azimuths_centideg = std::span(header.firing_azimuth_centideg).first(header.firings);
  spin_rate_.update(azimuths_centideg, static_cast<double>(layout_.block_ns()) * 1e-3);
  if (firing_time_azimuth_) projector_.set_turn_rate(spin_rate_.rad_per_s());
  return builder_.begin_packet({.first_firing_ns = first_firing_ns,
                                .receive_utc_ns = receive_utc_ns,
                                .duration_ns = static_cast<std::int64_t>(header.firings) * layout_.block_ns(),
                                .turn_ns = spin_rate_.turn_ns(),
                                .sequence = {}},
                               azimuths_centideg[0], sweeps);
}

DecodeResult BlockDecoder::decode(const Packet& packet, SweepPair& sweeps) noexcept {
  if (packet.payload.size() == kPositionBytes) return {.status = read_position(packet, builder_, position_)};
  if (packet.payload.size() != sizeof(WirePacket)) return {.status = DecodeStatus::wrong_size};
  WirePacket wire;
  std::memcpy(&wire, packet.payload.data(), sizeof(wire));
  Header header;
  if (const auto status = validate(wire, header); status != DecodeStatus::decoded) return {.status = status};

  // The packet's time is that of its first firing (section 9.3).
  const std::int64_t first_firing_ns =
      builder_.clock().expand_top_of_hour(header.top_of_hour_us, packet.receive_utc_ns);
  const DecodeStatus place = begin_packet(header, first_firing_ns, packet.receive_utc_ns, sweeps);
  if (place != DecodeStatus::decoded) return {.status = place};
  std::int64_t block_ns = first_firing_ns;
  for (std::size_t firing = 0; firing < header.firings; ++firing) {
    const std::uint16_t azimuth_centideg = header.firing_azimuth_centideg[firing];
    if (firing > 0) {
      block_ns += spin_rate_.time_between(header.firing_azimuth_centideg[firing - 1], azimuth_centideg,
                                          layout_.block_ns());
    }
    Block block{.azimuth_centideg = azimuth_centideg,
                .time_s = builder_.begin_block(azimuth_centideg, block_ns, sweeps),
                .unit_m = static_cast<float>(layout_.range_unit_m)};
    // Dual: the last return, then the strongest, or the second strongest if the strongest is the last.
    for (std::size_t i = 0; i < header.returns; ++i) {
      block.slots = wire.blocks[firing * header.returns + i].slots;
      projector_.project(block, gate_, sweeps.current());
      block.duplicates = block.slots;
    }
  }
  return {.status = DecodeStatus::decoded, .sweep_completed = builder_.has_cut()};
}

}  // namespace landfix::drivers::velodyne
