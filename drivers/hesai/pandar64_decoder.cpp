#include "drivers/hesai/pandar64_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/civil_time.hpp"

namespace landfix::drivers::hesai {
namespace {

// The last block ends 42.58 us before the packet's time, each one before it 55.56 us earlier (manual).
constexpr std::int64_t kLastBlockNs = -42'580;
constexpr std::int64_t kBlockNs = 55'560;
/// Where the beams start, beside the axis of rotation.
constexpr RotorVector kOpticalCentreM{.x = 0.03873, .y = 0.012, .z = 0.0};
constexpr std::uint32_t kLatestMicrosecond = 1'000'000;  // the manual includes the upper end
constexpr unsigned kNominalRpm = 600;
constexpr unsigned kFastestRpm = 3000;

double earliest_firing_us(std::span<const Beam, kPandar64Lasers> beams) noexcept {
  return std::ranges::min(beams, {}, &Beam::firing_time_us).firing_time_us;
}

std::array<FiringSlot, kPandar64Lasers> firing_slots(std::span<const Beam, kPandar64Lasers> beams,
                                                     bool optical_centre) noexcept {
  std::array<FiringSlot, kPandar64Lasers> slots;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    slots[i] = {.elevation_deg = beams[i].elevation_deg,
                .azimuth_offset_deg = beams[i].azimuth_offset_deg,
                .origin_m = optical_centre ? kOpticalCentreM : RotorVector{},
                .turning_time_s = beams[i].firing_time_us * 1e-6,
                .time_s = (beams[i].firing_time_us - earliest_firing_us(beams)) * 1e-6,
                .ring = beams[i].ring};
  }
  return slots;
}

/// How many blocks a firing has, 0 if the mode is none of the model's.
std::size_t returns_of(ReturnMode mode) noexcept {
  switch (mode) {
    case ReturnMode::strongest:
    case ReturnMode::last:
      return 1;
    case ReturnMode::dual:
      return 2;
  }
  return 0;
}

int year_of(std::byte year) noexcept {
  // The manual counts from 2000; recorded units count from 1900.
  const int count = std::to_integer<int>(year);
  return count < 100 ? 2000 + count : 1900 + count;
}

std::optional<std::int64_t> time_of(const WireTail& tail) noexcept {
  const auto microseconds = load_little_endian<std::uint32_t>(tail.microseconds);
  const auto seconds = unix_seconds({.year = year_of(tail.year),
                                     .month = std::to_integer<int>(tail.month),
                                     .day = std::to_integer<int>(tail.day),
                                     .hour = std::to_integer<int>(tail.hour),
                                     .minute = std::to_integer<int>(tail.minute),
                                     .second = std::to_integer<int>(tail.second)});
  if (!seconds || microseconds > kLatestMicrosecond) return std::nullopt;
  return *seconds * 1'000'000'000 + std::int64_t{microseconds} * 1000;
}

template <class Wire>
Wire load(std::span<const std::byte> payload, std::size_t offset) noexcept {
  Wire wire;
  std::memcpy(&wire, payload.data() + offset, sizeof(wire));
  return wire;
}

const std::byte* block_at(std::span<const std::byte> payload, std::size_t block) noexcept {
  return payload.data() + sizeof(WireHeader) + block * sizeof(WireBlock);
}

}  // namespace

Pandar64Decoder::Pandar64Decoder(std::span<const Beam, kPandar64Lasers> beams,
                                 const DecoderOptions& options) noexcept
    : projector_(firing_slots(beams, options.optical_centre), RangeFrom::sensor_centre),
      builder_(options.cut_deg),
      options_(options),
      earliest_firing_ns_(std::llround(earliest_firing_us(beams) * 1e3)) {}

DecodeStatus Pandar64Decoder::validate(std::span<const std::byte> payload, Header& header) const noexcept {
  if (payload.size() < packet_bytes(1)) return DecodeStatus::wrong_size;
  const auto wire = load<WireHeader>(payload, 0);
  if (wire.marker[0] != std::byte{0xEE} || wire.marker[1] != std::byte{0xFF})
    return DecodeStatus::wrong_header;
  const auto blocks = std::to_integer<std::size_t>(wire.block_count);
  if (blocks != 6 && blocks != 7) return DecodeStatus::wrong_header;
  const bool has_sequence = payload.size() == packet_bytes(blocks) + kSequenceBytes;
  if (!has_sequence && payload.size() != packet_bytes(blocks)) return DecodeStatus::wrong_size;
  if (std::to_integer<std::size_t>(wire.laser_count) != kPandar64Lasers) return DecodeStatus::wrong_model;
  header.range_unit_mm = std::to_integer<unsigned>(wire.range_unit_mm);
  if (header.range_unit_mm == 0) return DecodeStatus::wrong_header;

  const std::size_t tail_offset = packet_bytes(blocks) - sizeof(WireTail);
  const auto tail = load<WireTail>(payload, tail_offset);
  header.returns = returns_of(static_cast<ReturnMode>(tail.return_mode));
  if (header.returns == 0) return DecodeStatus::wrong_return_mode;
  if (blocks % header.returns != 0) return DecodeStatus::wrong_header;
  header.firings = blocks / header.returns;
  header.motor_rpm = load_little_endian<std::uint16_t>(tail.motor_rpm);
  if (header.motor_rpm > kFastestRpm) return DecodeStatus::wrong_header;
  const auto packed_ns = time_of(tail);
  if (!packed_ns) return DecodeStatus::wrong_time;
  header.packed_ns = *packed_ns;
  if (has_sequence) header.sequence = load_little_endian<std::uint32_t>(&payload[packet_bytes(blocks)]);
  return validate_azimuths(payload, header);
}

DecodeStatus Pandar64Decoder::validate_azimuths(std::span<const std::byte> payload,
                                                Header& header) const noexcept {
  for (std::size_t b = 0; b < header.firings * header.returns; ++b) {
    const auto azimuth_centideg = load_little_endian<std::uint16_t>(block_at(payload, b));
    if (azimuth_centideg >= kTurnCentideg) return DecodeStatus::wrong_azimuth;
    std::uint16_t& of_firing = header.firing_azimuth_centideg[b / header.returns];
    if (b % header.returns == 0) of_firing = azimuth_centideg;
    if (azimuth_centideg != of_firing) return DecodeStatus::wrong_azimuth;
  }
  const auto azimuths_centideg = std::span(header.firing_azimuth_centideg).first(header.firings);
  return builder_.cannot_be(azimuths_centideg) ? DecodeStatus::wrong_azimuth : DecodeStatus::decoded;
}

DecodeStatus Pandar64Decoder::begin_packet(const Header& header, std::int64_t first_firing_ns,
                                           std::int64_t receive_utc_ns, SweepPair& sweeps) noexcept {
  const unsigned rpm = header.motor_rpm == 0 ? kNominalRpm : header.motor_rpm;
  if (options_.firing_time_azimuth) projector_.set_turn_rate(rpm * (2.0 * std::numbers::pi / 60.0));
  return builder_.begin_packet({.first_firing_ns = first_firing_ns,
                                .receive_utc_ns = receive_utc_ns,
                                .duration_ns = static_cast<std::int64_t>(header.firings) * kBlockNs,
                                .turn_ns = 60'000'000'000 / rpm,
                                .sequence = header.sequence},
                               header.firing_azimuth_centideg[0], sweeps);
}

DecodeResult Pandar64Decoder::decode(const Packet& packet, SweepPair& sweeps) noexcept {
  Header header;
  const DecodeStatus status = validate(packet.payload, header);
  if (status != DecodeStatus::decoded) return {.status = status};

  const double unit_m = header.range_unit_mm * 1e-3;
  const RangeGate gate(unit_m, options_.min_range_m, options_.max_range_m);
  const auto firings = static_cast<std::int64_t>(header.firings);
  const std::int64_t first_firing_ns =
      header.packed_ns + kLastBlockNs - (firings - 1) * kBlockNs + earliest_firing_ns_;
  const DecodeStatus place = begin_packet(header, first_firing_ns, packet.receive_utc_ns, sweeps);
  if (place != DecodeStatus::decoded) return {.status = place};
  for (std::size_t firing = 0; firing < header.firings; ++firing) {
    const std::uint16_t azimuth_centideg = header.firing_azimuth_centideg[firing];
    const auto block_ns = first_firing_ns + static_cast<std::int64_t>(firing) * kBlockNs;
    Block block{.azimuth_centideg = azimuth_centideg,
                .time_s = builder_.begin_block(azimuth_centideg, block_ns, sweeps),
                .unit_m = static_cast<float>(unit_m)};
    // Dual: the last return, then the strongest, or the second strongest if the strongest is the last.
    for (std::size_t i = 0; i < header.returns; ++i) {
      block.slots =
          block_at(packet.payload, firing * header.returns + i) + sizeof(WireBlock::azimuth_centideg);
      projector_.project(block, gate, sweeps.current());
      block.duplicates = block.slots;
    }
  }
  return {.status = DecodeStatus::decoded, .sweep_completed = builder_.has_cut()};
}

}  // namespace landfix::drivers::hesai
