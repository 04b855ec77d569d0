#include "drivers/velodyne/vls128_decoder.hpp"

#include <cmath>
#include <cstring>

namespace landfix::drivers::velodyne {
namespace {

constexpr double kVls128RangeUnit_m = 0.004;
/// A sequence: eight groups of eight lasers, one slot of maintenance, eight groups, three of maintenance.
constexpr int kSlotsASequence = 20;
/// The packet's time is that of the fourth group of its first sequence.
constexpr std::int64_t kStampAfterFirstFiringNs = 8'700;
/// The projectors are made anew when the slot is measured to be another by more than this.
constexpr double kSlotStep = 0.001;

/// Slots from the first group's firing to the laser's.
double firing_slot(std::size_t laser) noexcept {
  const std::size_t slot = laser / 8 + laser / 64;
  return static_cast<double>(slot);
}

std::array<FiringSlot, kBlockSlots> slots_of_bank(std::span<const Beam, kVls128Lasers> beams,
                                                  std::size_t bank) noexcept {
  std::array<FiringSlot, kBlockSlots> slots;
  for (std::size_t i = 0; i < kBlockSlots; ++i) {
    const std::size_t laser = bank * kBlockSlots + i;
    slots[i] = {.elevation_deg = beams[laser].elevation_deg,
                .azimuth_offset_deg = beams[laser].azimuth_offset_deg,
                .origin_m = {},
                .turning_time_s = firing_slot(laser),
                .time_s = firing_slot(laser),
                .ring = beams[laser].ring};
  }
  return slots;
}

BlockProjector projector_of(std::array<FiringSlot, kBlockSlots> slots, double slot_us) noexcept {
  for (FiringSlot& slot : slots) {
    slot.turning_time_s *= slot_us * 1e-6;
    slot.time_s *= slot_us * 1e-6;
  }
  return {slots, RangeFrom::beam_origin};
}

/// Blocks that a bank has in a sequence, and how many of them are returns; 0 if the mode is none of the
/// model's.
struct BlocksABank {
  std::size_t blocks;
  std::size_t returns;
};
BlocksABank blocks_a_bank(ReturnMode mode) noexcept {
  switch (mode) {
    case ReturnMode::strongest:
    case ReturnMode::last:
      return {1, 1};
    case ReturnMode::dual:
      return {2, 2};
    case ReturnMode::triple:
      return {3, 3};
    case ReturnMode::dual_with_confidence:  // whose words are not used
      return {3, 2};
    case ReturnMode::unknown:
      break;
  }
  return {0, 0};
}

/// Blanks the ranges of `block` that are in `other` too.
void blank_repeated(WireBlock& block, const WireBlock& other) noexcept {
  for (std::size_t i = 0; i < kBlockSlots; ++i) {
    std::byte* const range_raw = block.slots + i * kSlotBytes;
    if (std::memcmp(range_raw, other.slots + i * kSlotBytes, 2) == 0) std::memset(range_raw, 0, 2);
  }
}

bool is_unused(const WireBlock& block) noexcept {
  const auto flag = load_little_endian<std::uint16_t>(block.flag);
  return flag == 0 || flag == 0xFFFF;
}

}  // namespace

Vls128Decoder::Vls128Decoder(std::span<const Beam, kVls128Lasers> beams,
                             const DecoderOptions& options) noexcept
    : projected_slot_us_(slot_.us()),
      slots_{slots_of_bank(beams, 0), slots_of_bank(beams, 1), slots_of_bank(beams, 2),
             slots_of_bank(beams, 3)},
      projectors_{projector_of(slots_[0], slot_.us()), projector_of(slots_[1], slot_.us()),
                  projector_of(slots_[2], slot_.us()), projector_of(slots_[3], slot_.us())},
      gate_(kVls128RangeUnit_m, options.min_range_m, options.max_range_m),
      builder_(options.cut_deg),
      firing_time_azimuth_(options.firing_time_azimuth) {}

DecodeStatus Vls128Decoder::validate(const WirePacket& wire, Header& header) const noexcept {
  if (wire.product != kVls128Product && wire.product != kVls128ProductOfTheManual)
    return DecodeStatus::wrong_model;
  const auto [blocks, returns] = blocks_a_bank(static_cast<ReturnMode>(wire.return_mode));
  if (blocks == 0) return DecodeStatus::wrong_return_mode;
  header.blocks_a_bank = blocks;
  header.returns = returns;
  const std::size_t blocks_a_sequence = kBanks * blocks;
  header.sequences = kBlocks / blocks_a_sequence;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const WireBlock& block = wire.blocks[b];
    const std::size_t sequence = b / blocks_a_sequence;
    if (sequence == header.sequences) {  // dual: four blocks are left over
      if (!is_unused(block)) return DecodeStatus::wrong_header;
      continue;
    }
    const std::size_t bank = b % blocks_a_sequence / blocks;
    if (load_little_endian<std::uint16_t>(block.flag) != kBankFlags[bank]) return DecodeStatus::wrong_header;
    const auto azimuth_centideg = load_little_endian<std::uint16_t>(block.azimuth_centideg);
    if (azimuth_centideg >= kTurnCentideg) return DecodeStatus::wrong_azimuth;
    if (b % blocks_a_sequence == 0) header.azimuth_centideg[sequence] = azimuth_centideg;
    if (azimuth_centideg != header.azimuth_centideg[sequence]) return DecodeStatus::wrong_azimuth;
  }
  if (builder_.cannot_be(std::span(header.azimuth_centideg).first(header.sequences))) {
    return DecodeStatus::wrong_azimuth;
  }
  header.top_of_hour_us = load_little_endian<std::uint32_t>(wire.top_of_hour_us);
  return header.top_of_hour_us <= kLatestTopOfHourUs ? DecodeStatus::decoded : DecodeStatus::wrong_time;
}

void Vls128Decoder::measure(const Header& header, std::int64_t first_firing_ns) noexcept {
  const int slots = static_cast<int>(header.sequences) * kSlotsASequence;
  const std::int64_t spacing_ns = first_firing_ns - last_firing_ns_;
  if (last_azimuth_centideg_) slot_.update(spacing_ns, slots);
  const double sequence_us = slot_.us() * kSlotsASequence;
  if (header.sequences > 1) {
    spin_rate_.update(std::span(header.azimuth_centideg).first(header.sequences), sequence_us);
  } else if (last_azimuth_centideg_ && static_cast<double>(spacing_ns) * 1e-3 < 1.5 * sequence_us) {
    // One sequence a packet: the one before is in the packet before.
    const std::array<std::uint16_t, 2> azimuths{*last_azimuth_centideg_, header.azimuth_centideg[0]};
    spin_rate_.update(azimuths, sequence_us);
  }
  last_firing_ns_ = first_firing_ns;
  last_azimuth_centideg_ = header.azimuth_centideg[header.sequences - 1];
}

void Vls128Decoder::fit_projectors() noexcept {
  if (std::abs(slot_.us() - projected_slot_us_) > kSlotStep * projected_slot_us_) {
    projected_slot_us_ = slot_.us();
    for (std::size_t bank = 0; bank < kBanks; ++bank) {
      projectors_[bank] = projector_of(slots_[bank], projected_slot_us_);
    }
  }
  if (!firing_time_azimuth_) return;
  for (BlockProjector& projector : projectors_) projector.set_turn_rate(spin_rate_.rad_per_s());
}

DecodeResult Vls128Decoder::decode(const Packet& packet, SweepPair& sweeps) noexcept {
  if (packet.payload.size() == kPositionBytes) return {.status = read_position(packet, builder_, position_)};
  if (packet.payload.size() != sizeof(WirePacket)) return {.status = DecodeStatus::wrong_size};
  WirePacket wire;
  std::memcpy(&wire, packet.payload.data(), sizeof(wire));
  Header header;
  if (const auto status = validate(wire, header); status != DecodeStatus::decoded) return {.status = status};

  const std::int64_t first_firing_ns =
      builder_.clock().expand_top_of_hour(header.top_of_hour_us, packet.receive_utc_ns) -
      kStampAfterFirstFiringNs;
  const auto sequence_ns = static_cast<std::int64_t>(slot_.us() * kSlotsASequence * 1e3);
  const DecodeStatus place =
      builder_.begin_packet({.first_firing_ns = first_firing_ns,
                             .receive_utc_ns = packet.receive_utc_ns,
                             .duration_ns = static_cast<std::int64_t>(header.sequences) * sequence_ns,
                             .turn_ns = spin_rate_.turn_ns(),
                             .sequence = {}},
                            header.azimuth_centideg[0], sweeps);
  if (place != DecodeStatus::decoded) return {.status = place};
  measure(header, first_firing_ns);
  fit_projectors();

  std::int64_t sequence_start_ns = first_firing_ns;
  for (std::size_t sequence = 0; sequence < header.sequences; ++sequence) {
    const std::uint16_t azimuth_centideg = header.azimuth_centideg[sequence];
    if (sequence > 0) {
      sequence_start_ns +=
          spin_rate_.time_between(header.azimuth_centideg[sequence - 1], azimuth_centideg, sequence_ns);
    }
    Block block{.azimuth_centideg = azimuth_centideg,
                .time_s = builder_.begin_block(azimuth_centideg, sequence_start_ns, sweeps),
                .unit_m = static_cast<float>(kVls128RangeUnit_m)};
    const std::size_t first_block = sequence * kBanks * header.blocks_a_bank;
    for (std::size_t bank = 0; bank < kBanks; ++bank) {
      block.duplicates = nullptr;
      WireBlock* const of_bank = wire.blocks + first_block + bank * header.blocks_a_bank;
      // The projector compares a return with the one before it, so a third with the second.
      if (header.returns == 3) blank_repeated(of_bank[2], of_bank[0]);
      // Dual: the last return, then the strongest, or the second strongest if the strongest is the last.
      for (std::size_t i = 0; i < header.returns; ++i) {
        block.slots = of_bank[i].slots;
        projectors_[bank].project(block, gate_, sweeps.current());
        block.duplicates = block.slots;
      }
    }
  }
  return {.status = DecodeStatus::decoded, .sweep_completed = builder_.has_cut()};
}

}  // namespace landfix::drivers::velodyne
