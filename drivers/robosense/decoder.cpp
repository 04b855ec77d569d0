#include "drivers/robosense/decoder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/robosense/laser_groups.hpp"
#include "drivers/sweep_cutter.hpp"

namespace landfix::drivers::robosense {
namespace {

constexpr std::size_t kHalfBlockBytes = kBlockSlots / 2 * kSlotBytes;
/// 50 rpm: below it the rotor is starting or stands still.
constexpr double kSlowestCentidegPerUs = 0.03;

const std::byte* slots_of(std::span<const std::byte> payload, std::size_t block) noexcept {
  return &payload[block_at(block) + 4];
}

/// What the returns of a block of two are compared with: the first with none, the second with the first.
BlockSlotBytes first_returns(const std::byte* slots) noexcept {
  BlockSlotBytes others{};
  std::copy_n(slots, kHalfBlockBytes, others.begin() + kHalfBlockBytes);
  return others;
}

std::int64_t to_ns(double microseconds) noexcept { return std::llround(microseconds * 1e3); }

}  // namespace

Decoder::Decoder(const Description& model, std::span<const Beam> beams,
                 const DecoderOptions& options) noexcept
    : model_(&model),
      options_(options),
      builder_(options.cut_deg),
      from_file_(beams.size() == model.lasers),
      calibrated_(from_file_),
      centimetres_(options.range_unit_m == kCentimetre),
      layout_(model.lasers == kBlockSlots ? Layout::one_firing : Layout::two_firings) {
  if (!calibrated_) return;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    angles_[i] = {.elevation_deg = beams[i].elevation_deg, .azimuth_offset_deg = beams[i].azimuth_offset_deg};
  }
  arrange(layout_);
}

void Decoder::arrange(Layout layout) noexcept {
  layout_ = layout;
  const double pace = layout == Layout::close_firings ? 0.5 : 1.0;
  const auto elevation_deg = [&](std::size_t laser) { return angles_[laser].elevation_deg; };
  std::array<FiringSlot, kBlockSlots> slots;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const std::size_t laser = i % model_->lasers;
    const bool same_firing = i < model_->lasers || layout == Layout::two_returns;
    const double before_us = same_firing ? 0.0 : model_->firing_period_us;
    const double time_s = pace * (before_us + model_->firing_time_us[laser]) * 1e-6;
    slots[i] = {.elevation_deg = angles_[laser].elevation_deg,
                .azimuth_offset_deg = angles_[laser].azimuth_offset_deg,
                .origin_m = {.x = options_.optical_centre ? model_->lens_forward_m : 0.0},
                .turning_time_s = time_s,
                .time_s = time_s,
                .ring = ring_of(laser, model_->lasers, elevation_deg)};
  }
  projector_ = BlockProjector(slots, RangeFrom::beam_origin, ByteOrder::big);
}

DecodeStatus Decoder::take_device_info(std::span<const std::byte> payload) noexcept {
  DeviceInfo info;
  const DecodeStatus status = read_device_info(*model_, payload, info);
  of_another_model_ = status == DecodeStatus::wrong_model;
  if (status != DecodeStatus::telemetry) return status;
  speed_.set_nominal(info.motor_rpm);
  dual_return_ = info.dual_return;
  if (!options_.range_unit_m) centimetres_ = info.counts_centimetres;
  if (!info.angles || from_file_ || (calibrated_ && *info.angles == angles_)) return status;
  angles_ = *info.angles;
  calibrated_ = true;
  arrange(layout_);
  return status;
}

double Decoder::block_period_us() const noexcept {
  return model_->firing_period_us * (layout_ == Layout::two_firings ? 2.0 : 1.0);
}

Decoder::Layout Decoder::layout_of(const DataHeader& header) const noexcept {
  if (model_->lasers == kBlockSlots) return Layout::one_firing;
  const double step_centideg = mean_step_centideg(header.azimuth_centideg);
  if (step_centideg == 0.0) return layout_;
  const double period_us = step_centideg / speed_.centideg_per_us();
  if (period_us > 1.5 * model_->firing_period_us) return Layout::two_firings;
  return dual_return_.value_or(true) ? Layout::two_returns : Layout::close_firings;
}

bool Decoder::fits_range_unit(std::span<const std::byte> payload) const noexcept {
  if (!model_->had_centimetre_firmware) return true;
  if (centimetres_) {
    for (std::size_t b = 0; b < kBlocks; ++b) {
      if (group_of(slots_of(payload, b)) == LaserGroup::mixed) return false;
    }
    return true;
  }
  if (options_.range_unit_m) return true;
  // Two in a row, as the groups may take turns.
  return !seems_of_group_b(slots_of(payload, 2)) && !seems_of_group_b(slots_of(payload, 3));
}

Decoder::Firings Decoder::firings_of(const DataHeader& header) const noexcept {
  Firings firings;
  firings.in_pairs = layout_ == Layout::one_firing && come_in_pairs(header.azimuth_centideg);
  const std::size_t stride = firings.in_pairs ? 2 : 1;
  firings.count = kBlocks / stride;
  for (std::size_t f = 0; f < firings.count; ++f)
    firings.azimuth_centideg[f] = header.azimuth_centideg[f * stride];
  const auto azimuths_centideg = std::span(firings.azimuth_centideg).first(firings.count);
  const double step_centideg = mean_step_centideg(azimuths_centideg);
  firings.centideg_per_us = step_centideg == 0.0
                                ? speed_.centideg_per_us()
                                : std::max(step_centideg / block_period_us(), kSlowestCentidegPerUs);
  const std::int64_t period_ns = to_ns(block_period_us());
  std::int64_t after_ns = 0;
  for (std::size_t f = 0; f < firings.count; ++f) {
    firings.after_ns[f] = after_ns;
    const int step =
        f + 1 < firings.count ? turned_centideg(azimuths_centideg[f], azimuths_centideg[f + 1]) : 0;
    // Half a turn ahead is a step back.
    const bool gap = step > kWidestStepCentideg && step < kTurnCentideg / 2;
    after_ns += gap ? to_ns(step / firings.centideg_per_us) : period_ns;
  }
  firings.duration_ns = after_ns;
  return firings;
}

void Decoder::project_firing(const std::byte* first, const std::byte* second, Block block,
                             const RangeGate& gate, Sweep& sweep) const noexcept {
  block.slots = first;
  projector_.project(block, gate, sweep);
  if (second == nullptr) return;
  block.duplicates = first;
  block.slots = second;
  projector_.project(block, gate, sweep);
}

void Decoder::project(std::span<const std::byte> payload, const DataHeader& header, const Firings& firings,
                      SweepPair& sweeps) noexcept {
  const double unit_m = centimetres_ ? kCentimetre : header.range_unit_m;
  const RangeGate gate(unit_m, options_.min_range_m, options_.max_range_m);
  const std::size_t stride = kBlocks / firings.count;
  for (std::size_t f = 0; f < firings.count; ++f) {
    const std::uint16_t azimuth_centideg = firings.azimuth_centideg[f];
    const std::int64_t firing_ns = header.first_firing_ns + firings.after_ns[f];
    Block block{.azimuth_centideg = azimuth_centideg,
                .time_s = builder_.begin_block(azimuth_centideg, firing_ns, sweeps),
                .unit_m = static_cast<float>(unit_m)};
    const std::byte* const first = slots_of(payload, f * stride);
    const std::byte* const second = firings.in_pairs ? slots_of(payload, f * 2 + 1) : nullptr;
    if (centimetres_) {
      const BlockSlotBytes ordered = in_order(first);
      const BlockSlotBytes ordered_second = in_order(second == nullptr ? first : second);
      project_firing(ordered.data(), second == nullptr ? nullptr : ordered_second.data(), block, gate,
                     sweeps.current());
    } else if (layout_ == Layout::two_returns) {
      const BlockSlotBytes others = first_returns(first);
      block.duplicates = others.data();
      project_firing(first, nullptr, block, gate, sweeps.current());
    } else {
      project_firing(first, second, block, gate, sweeps.current());
    }
  }
}

DecodeResult Decoder::decode(const Packet& packet, SweepPair& sweeps) noexcept {
  const auto payload = packet.payload;
  if (payload.size() != kPacketBytes) return {.status = DecodeStatus::wrong_size};
  if (is_device_info(payload)) return {.status = take_device_info(payload)};
  DataHeader header;
  const DecodeStatus status = read_data_header(*model_, payload, header);
  if (status != DecodeStatus::decoded) return {.status = status};
  // The data packets of the RS-LiDAR-16 and -32 are alike: only what the unit says of itself tells them
  // apart.
  if (!calibrated_)
    return {.status = of_another_model_ ? DecodeStatus::wrong_model : DecodeStatus::uncalibrated};
  if (!fits_range_unit(payload)) return {.status = DecodeStatus::wrong_header};

  if (builder_.cannot_be(header.azimuth_centideg)) return {.status = DecodeStatus::wrong_azimuth};
  speed_.update(header.azimuth_centideg[0], header.first_firing_ns);
  if (const Layout layout = layout_of(header); layout != layout_) arrange(layout);
  const Firings firings = firings_of(header);
  const auto azimuths_centideg = std::span(firings.azimuth_centideg).first(firings.count);
  const DecodeStatus place = builder_.begin_packet({.first_firing_ns = header.first_firing_ns,
                                                    .receive_utc_ns = packet.receive_utc_ns,
                                                    .duration_ns = firings.duration_ns,
                                                    .turn_ns = to_ns(kTurnCentideg / firings.centideg_per_us),
                                                    .sequence = {}},
                                                   azimuths_centideg[0], sweeps);
  if (place != DecodeStatus::decoded) return {.status = place};
  if (options_.firing_time_azimuth) {
    projector_.set_turn_rate(firings.centideg_per_us * 1e6 * (0.01 * std::numbers::pi / 180.0));
  }
  project(payload, header, firings, sweeps);
  return {.status = DecodeStatus::decoded, .sweep_completed = builder_.has_cut()};
}

}  // namespace landfix::drivers::robosense
