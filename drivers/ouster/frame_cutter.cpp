#include "drivers/ouster/frame_cutter.hpp"

#include <algorithm>
#include <bit>

namespace landfix::drivers::ouster {
namespace {

/// Networks delay packets by less than this; an older frame that is further back was sent before a restart.
constexpr std::int64_t kLateNs = 1'000'000'000;
/// Of a frame of few packets so many may be late all the same.
constexpr std::uint32_t kLeastRefusals = 16;
constexpr std::int64_t kSecondNs = 1'000'000'000;

}  // namespace

std::uint32_t PacketSet::size() const noexcept { return missing_in({}, 0); }

std::uint32_t PacketSet::missing_in(const PacketSet& other, std::size_t first) const noexcept {
  int count = 0;
  for (std::size_t i = first / 64; i < words_.size(); ++i) {
    std::uint64_t missing = words_[i] & ~other.words_[i];
    if (i == first / 64) missing &= ~std::uint64_t{0} << (first % 64);
    count += std::popcount(missing);
  }
  return static_cast<std::uint32_t>(count);
}

FrameCutter::FrameCutter(const Metadata& metadata) noexcept
    : frame_id_bits_(metadata.header_type == HeaderType::fusa ? 32 : 16),
      turn_ns_(kSecondNs / std::max(1, metadata.frames_per_s)) {
  // Packets wholly outside the window are not sent; partly covered ones are.
  for (std::size_t column = 0; column < metadata.columns_per_frame; ++column) {
    if (metadata.window.contains(column)) expected_.insert(column / metadata.columns_per_packet);
  }
  expected_count_ = expected_.size();
}

std::int32_t FrameCutter::frames_ahead(std::uint32_t frame_id) const noexcept {
  const std::uint32_t ahead = frame_id - frame_id_;
  return frame_id_bits_ == 16 ? static_cast<std::int16_t>(ahead) : static_cast<std::int32_t>(ahead);
}

bool FrameCutter::fits_time(std::int32_t frames, const FramePacket& packet) const noexcept {
  if (!packet.first_firing_ns) return true;
  const std::int64_t turns = std::max<std::int64_t>(0, *packet.first_firing_ns - newest_ns_) / turn_ns_;
  return frames <= 2 * turns + 2;  // turns are not exact, least so while the sensor gets up to speed
}

FrameCutter::Place FrameCutter::place_in_same_frame(const FramePacket& packet) const noexcept {
  // Within a frame time goes with the number. Firmware up to 1.10 has no frame ids: they are always 0.
  const bool newer = timed_ && packet.first_firing_ns && *packet.first_firing_ns > newest_ns_;
  if (newer && (packet.number <= newest_number_ || *packet.first_firing_ns - newest_ns_ > turn_ns_)) {
    return Place::next_frame;
  }
  return received_.contains(packet.number) ? Place::duplicate : Place::same_frame;
}

FrameCutter::Place FrameCutter::place_of(const FramePacket& packet) const noexcept {
  if (!started_) return Place::next_frame;
  if (packet.init_id != 0 && init_id_ != 0 && packet.init_id != init_id_) return Place::restarted;
  // A stream that is late for a whole frame is not late: it was set back.
  if (refused_in_a_row_ >= std::max(expected_count_, kLeastRefusals)) return Place::restarted;
  const std::int32_t ahead = frames_ahead(packet.frame_id);
  if (ahead == 0) return place_in_same_frame(packet);
  if (ahead > 0) return fits_time(ahead, packet) ? Place::next_frame : Place::restarted;
  if (!packet.first_firing_ns) return Place::late;
  const std::int64_t behind_ns = newest_ns_ - *packet.first_firing_ns;
  return behind_ns >= 0 && behind_ns <= kLateNs ? Place::late : Place::restarted;
}

ClockVerdict FrameCutter::advance_clock(const FramePacket& packet, Place place) noexcept {
  if (!packet.first_firing_ns) return ClockVerdict::continues;
  const bool overtaken = place == Place::same_frame && packet.number < newest_number_ &&
                         *packet.first_firing_ns < newest_ns_ &&
                         newest_ns_ - *packet.first_firing_ns < turn_ns_;
  if (overtaken) return ClockVerdict::continues;
  return clock_.advance(*packet.first_firing_ns, packet.receive_utc_ns);
}

DecodeStatus FrameCutter::begin_packet(const FramePacket& packet, SweepPair& sweeps) noexcept {
  has_cut_ = false;
  Place place = place_of(packet);
  if (place == Place::duplicate || place == Place::late) {
    ++refused_in_a_row_;
    return place == Place::late ? DecodeStatus::late : DecodeStatus::duplicate;
  }
  const ClockVerdict verdict = advance_clock(packet, place);
  if (verdict == ClockVerdict::doubtful) return DecodeStatus::wrong_time;
  refused_in_a_row_ = 0;
  const bool stepped = verdict == ClockVerdict::stepped;
  counters_.clock_steps += stepped && place != Place::restarted ? 1 : 0;
  // It was the clock that went on, not the frame.
  const bool same_id = started_ && packet.frame_id == frame_id_ && !received_.contains(packet.number);
  if (stepped && place == Place::next_frame && same_id) place = Place::same_frame;
  if (place != Place::same_frame) {
    end_frame(packet, place, sweeps);
    begin_frame(packet, place);
  }
  received_.insert(packet.number);
  ++received_count_;
  if (packet.first_firing_ns) begin_sweep(packet, stepped, sweeps);
  return DecodeStatus::decoded;
}

void FrameCutter::end_frame(const FramePacket& packet, Place place, SweepPair& sweeps) noexcept {
  if (!started_) return;
  if (place == Place::restarted) {
    ++counters_.restarts;  // and what is missing was never sent
  } else {
    const std::uint32_t missing = expected_.missing_in(received_, joined_at_);
    // Without a time the id alone says so, which may be damaged.
    const std::int32_t skipped = packet.first_firing_ns ? std::max(0, frames_ahead(packet.frame_id) - 1) : 0;
    counters_.lost_packets += missing + static_cast<std::uint64_t>(skipped) * expected_count_;
    if (open_) sweeps.current().lose_packets(missing);
  }
  if (open_) close(sweeps);
}

void FrameCutter::begin_frame(const FramePacket& packet, Place place) noexcept {
  const bool joins = !started_ || place == Place::restarted;
  joined_at_ = joins ? packet.number : 0;
  started_ = true;
  frame_id_ = packet.frame_id;
  init_id_ = packet.init_id;
  received_ = {};
  received_count_ = 0;
  newest_number_ = 0;
  torn_ = false;
  timed_ = false;
}

void FrameCutter::begin_sweep(const FramePacket& packet, bool stepped, SweepPair& sweeps) noexcept {
  const std::int64_t first_ns = *packet.first_firing_ns;
  if (stepped && open_) {
    torn_ = true;
    close(sweeps);
  }
  if (!open_) {
    open_ = true;
    sweep_start_ns_ = first_ns;
    sweeps.current().begin(clock_.to_utc_ns(first_ns), true, clock_.time_source());
  } else if (first_ns < sweep_start_ns_) {
    sweeps.current().begin_earlier(sweep_start_ns_ - first_ns);
    sweep_start_ns_ = first_ns;
  }
  if (stepped || !timed_ || packet.number >= newest_number_) {
    timed_ = true;
    newest_number_ = packet.number;
    newest_ns_ = first_ns;
  }
}

bool FrameCutter::end_packet(SweepPair& sweeps) noexcept {
  // A packet hands over one sweep: where a frame is a single packet, the next one hands it over.
  if (open_ && is_complete() && !has_cut_) close(sweeps);
  return has_cut_;
}

void FrameCutter::close(SweepPair& sweeps) noexcept {
  if (!is_complete() || torn_) sweeps.current().mark_partial();
  open_ = false;
  has_cut_ = true;
  sweeps.cut();
  // Nothing of an older sweep shows until the next begins.
  sweeps.current().begin(sweeps.completed().end_utc_ns(), false, clock_.time_source());
}

bool FrameCutter::flush(SweepPair& sweeps) noexcept {
  if (!open_ || sweeps.current().empty()) return false;
  // Of the rest nothing is known yet.
  const std::uint32_t gaps =
      expected_.missing_in(received_, joined_at_) - expected_.missing_in(received_, newest_number_);
  counters_.lost_packets += gaps;
  sweeps.current().lose_packets(gaps);
  joined_at_ = newest_number_;
  torn_ = !is_complete();
  close(sweeps);
  return true;
}

}  // namespace landfix::drivers::ouster
