#include "drivers/hesai/pandar_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/hesai/gps_packet.hpp"
#include "drivers/hesai/tail_time.hpp"

namespace landfix::drivers::hesai {
namespace {

constexpr unsigned kNominalRpm = 600;
constexpr unsigned kFastestRpm = 3000;

double earliest_firing_us(std::span<const Beam> beams) noexcept {
  return std::ranges::min(beams, {}, &Beam::firing_time_us).firing_time_us;
}

/// The block's azimuth is that of its end: firing times are negative.
BlockProjector projector_of(std::span<const Beam> beams, const RotorVector& origin_m) noexcept {
  std::array<FiringSlot, kMaxSlots> slots;
  const std::size_t count = std::min(beams.size(), slots.size());
  for (std::size_t i = 0; i < count; ++i) {
    slots[i] = {.elevation_deg = beams[i].elevation_deg,
                .azimuth_offset_deg = beams[i].azimuth_offset_deg,
                .origin_m = origin_m,
                .turning_time_s = beams[i].firing_time_us * 1e-6,
                .time_s = (beams[i].firing_time_us - earliest_firing_us(beams)) * 1e-6,
                .ring = beams[i].ring};
  }
  return {std::span(slots).first(count), RangeFrom::sensor_centre};
}

/// How many blocks a firing has, 0 if the mode is none of the family's.
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

template <class Wire>
Wire load(std::span<const std::byte> payload, std::size_t offset) noexcept {
  Wire wire;
  std::memcpy(&wire, payload.data() + offset, sizeof(wire));
  return wire;
}

/// Packets with a header say there how many lasers the sensor has, or which newer protocol they follow;
/// those without begin with a block.
bool is_of_another_model(const PandarLayout& layout, std::span<const std::byte> payload) noexcept {
  if (payload.size() < sizeof(WireHeader)) return false;
  const auto marker = load<std::uint16_t>(payload, 0);
  if (layout.header_bytes == 0) return marker == kHeaderMarker;
  return marker == kBlockMarker ||
         (marker == kHeaderMarker &&
          std::to_integer<std::size_t>(load<WireHeader>(payload, 0).laser_count) != layout.lasers);
}

}  // namespace

PandarDecoder::PandarDecoder(const PandarLayout& layout, std::span<const Beam> beams,
                             const DecoderOptions& options) noexcept
    : layout_(&layout),
      projector_(projector_of(beams, options.optical_centre ? layout.optical_centre_m : RotorVector{})),
      builder_(options.cut_deg),
      options_(options),
      earliest_firing_ns_(std::llround(earliest_firing_us(beams) * 1e3)) {}

DecodeStatus PandarDecoder::read(std::span<const std::byte> payload, Content& content) const noexcept {
  if (is_of_another_model(*layout_, payload)) return DecodeStatus::wrong_model;
  DecodeStatus status = read_frame(payload, content);
  if (status == DecodeStatus::decoded) status = read_tail(payload, content);
  if (status == DecodeStatus::decoded) status = read_azimuths(payload, content);
  return status;
}

DecodeStatus PandarDecoder::read_frame(std::span<const std::byte> payload, Content& content) const noexcept {
  if (payload.size() < layout_->packet_bytes(1)) return DecodeStatus::wrong_size;
  content.blocks = layout_->blocks.front();
  content.range_unit_mm = layout_->range_unit_mm;
  if (layout_->header_bytes != 0) {
    const auto header = load<WireHeader>(payload, 0);
    if (load_little_endian<std::uint16_t>(header.marker) != kHeaderMarker) return DecodeStatus::wrong_header;
    content.blocks = std::to_integer<std::size_t>(header.block_count);
    content.range_unit_mm = std::to_integer<unsigned>(header.range_unit_mm);
    const bool known = std::ranges::find(layout_->blocks, content.blocks) != layout_->blocks.end();
    if (!known || content.range_unit_mm == 0) return DecodeStatus::wrong_header;
  }
  const std::size_t bytes = layout_->packet_bytes(content.blocks);
  if (payload.size() == bytes + kSequenceBytes) content.sequence = load<std::uint32_t>(payload, bytes);
  return content.sequence || payload.size() == bytes ? DecodeStatus::decoded : DecodeStatus::wrong_size;
}

DecodeStatus PandarDecoder::read_tail(std::span<const std::byte> payload, Content& content) const noexcept {
  const auto tail = load<WireTail>(payload, layout_->block_at(content.blocks));
  content.returns = returns_of(static_cast<ReturnMode>(tail.return_mode));
  if (content.returns == 0) return DecodeStatus::wrong_return_mode;
  if (content.blocks % content.returns != 0) return DecodeStatus::wrong_header;
  content.firings = content.blocks / content.returns;
  content.motor_rpm = load_little_endian<std::uint16_t>(tail.motor_rpm);
  if (content.motor_rpm > kFastestRpm) return DecodeStatus::wrong_header;
  const auto packed_ns = packed_ns_of(tail);
  if (!packed_ns) return DecodeStatus::wrong_time;
  content.packed_ns = *packed_ns;
  return DecodeStatus::decoded;
}

DecodeStatus PandarDecoder::read_azimuths(std::span<const std::byte> payload,
                                          Content& content) const noexcept {
  for (std::size_t b = 0; b < content.blocks; ++b) {
    const std::byte* const block = payload.data() + layout_->block_at(b);
    if (layout_->block_marker_bytes != 0 && load_little_endian<std::uint16_t>(block) != kBlockMarker) {
      return DecodeStatus::wrong_header;
    }
    const auto azimuth_centideg = load_little_endian<std::uint16_t>(block + layout_->block_marker_bytes);
    if (azimuth_centideg >= kTurnCentideg) return DecodeStatus::wrong_azimuth;
    std::uint16_t& of_firing = content.firing_azimuth_centideg[b / content.returns];
    if (b % content.returns == 0) of_firing = azimuth_centideg;
    if (azimuth_centideg != of_firing) return DecodeStatus::wrong_azimuth;
  }
  const auto azimuths_centideg = std::span(content.firing_azimuth_centideg).first(content.firings);
  return builder_.cannot_be(azimuths_centideg) ? DecodeStatus::wrong_azimuth : DecodeStatus::decoded;
}

DecodeStatus PandarDecoder::begin_packet(const Content& content, std::int64_t first_firing_ns,
                                         std::int64_t receive_utc_ns, SweepPair& sweeps) noexcept {
  const unsigned rpm = content.motor_rpm == 0 ? kNominalRpm : content.motor_rpm;
  if (options_.firing_time_azimuth) projector_.set_turn_rate(rpm * (2.0 * std::numbers::pi / 60.0));
  return builder_.begin_packet({.first_firing_ns = first_firing_ns,
                                .receive_utc_ns = receive_utc_ns,
                                .duration_ns = static_cast<std::int64_t>(content.firings) * layout_->block_ns,
                                .turn_ns = 60'000'000'000 / rpm,
                                .sequence = content.sequence},
                               content.firing_azimuth_centideg[0], sweeps);
}

DecodeStatus PandarDecoder::take_gps(const Packet& packet) noexcept {
  // Data packets carry the full date; this one tells whether it is right.
  const auto utc_ns = gps_utc_ns(packet.payload.first<kGpsBytes>());
  if (utc_ns) builder_.learn_utc(*utc_ns, packet.receive_utc_ns);
  return DecodeStatus::telemetry;
}

DecodeResult PandarDecoder::decode(const Packet& packet, SweepPair& sweeps) noexcept {
  if (is_gps_packet(packet.payload)) return {.status = take_gps(packet)};
  Content content;
  const DecodeStatus status = read(packet.payload, content);
  if (status != DecodeStatus::decoded) return {.status = status};

  const double unit_m = content.range_unit_mm * 1e-3;
  const RangeGate gate(unit_m, options_.min_range_m, options_.max_range_m);
  const auto firings = static_cast<std::int64_t>(content.firings);
  // The packet's time is taken after its last block.
  const std::int64_t first_firing_ns =
      content.packed_ns + layout_->last_block_ns - (firings - 1) * layout_->block_ns + earliest_firing_ns_;
  const DecodeStatus place = begin_packet(content, first_firing_ns, packet.receive_utc_ns, sweeps);
  if (place != DecodeStatus::decoded) return {.status = place};
  const std::byte* slots = packet.payload.data() + layout_->block_at(1) - layout_->lasers * kSlotBytes;
  for (std::size_t firing = 0; firing < content.firings; ++firing) {
    const std::uint16_t azimuth_centideg = content.firing_azimuth_centideg[firing];
    const auto block_ns = first_firing_ns + static_cast<std::int64_t>(firing) * layout_->block_ns;
    Block block{.azimuth_centideg = azimuth_centideg,
                .time_s = builder_.begin_block(azimuth_centideg, block_ns, sweeps),
                .unit_m = static_cast<float>(unit_m)};
    // Dual: the last return, then the strongest, or the second strongest if the strongest is the last.
    for (std::size_t i = 0; i < content.returns; ++i, slots += layout_->block_bytes()) {
      block.slots = slots;
      projector_.project(block, gate, sweeps.current());
      block.duplicates = slots;
    }
  }
  return {.status = DecodeStatus::decoded, .sweep_completed = builder_.has_cut()};
}

}  // namespace landfix::drivers::hesai
