#include "drivers/sweep_builder.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace landfix::drivers {
namespace {

/// The last packet before a dark sector begins up to its own span, at most 10 deg, before the sector.
constexpr int kSamePlaceCentideg = 1000;
/// A restricted field of view sends nothing over the same sector in every turn, at least a 36th of it; a loss
/// is seldom as long, and hardly ever again in the same place a turn later.
constexpr std::int64_t kDarkShareOfTurn = 36;
constexpr std::int64_t kMostLost = 1'000'000'000;
/// Networks reorder packets by less than this.
constexpr std::int64_t kOvertakenByNs = 10'000'000;

bool same_place(int a_centideg, int b_centideg) noexcept {
  const int apart = std::abs(a_centideg - b_centideg);
  return apart < kSamePlaceCentideg || apart > kTurnCentideg - kSamePlaceCentideg;
}

}  // namespace

void SweepBuilder::learn_utc(std::int64_t sensor_utc_ns, std::int64_t receive_utc_ns) noexcept {
  if (clock_.learn_utc(sensor_utc_ns, receive_utc_ns)) utc_changed_ = true;
}

DecodeStatus SweepBuilder::begin_packet(const PacketTiming& packet, std::uint16_t first_azimuth_centideg,
                                        SweepPair& sweeps) noexcept {
  has_cut_ = false;
  if (history_.contains(packet.first_firing_ns)) return DecodeStatus::duplicate;
  overtaken_ = is_overtaken(packet);
  if (overtaken_) return join_late(packet, sweeps);
  const ClockVerdict verdict = clock_.advance(packet.first_firing_ns, packet.receive_utc_ns);
  if (verdict == ClockVerdict::doubtful) return DecodeStatus::wrong_time;
  history_.insert(packet.first_firing_ns);
  const bool stepped = std::exchange(utc_changed_, false) || verdict == ClockVerdict::stepped;
  const bool restarted = restarts(packet);
  const std::uint32_t lost = stepped || restarted ? 0 : lost_before(packet);
  counters_.clock_steps += stepped ? 1 : 0;
  counters_.restarts += restarted ? 1 : 0;
  counters_.lost_packets += lost;
  lost_ = stepped || restarted || lost != 0;
  if (open_) {
    sweeps.current().lose_packets(lost);
    const std::int64_t elapsed_ns = packet.first_firing_ns - sweep_start_ns_;
    if (stepped || restarted || elapsed_ns > packet.turn_ns + packet.turn_ns / 2) end_turn(sweeps);
  }
  started_ = true;
  newest_packet_ns_ = packet.first_firing_ns;
  newest_sequence_ = packet.sequence;
  newest_azimuth_centideg_ = first_azimuth_centideg;
  return DecodeStatus::decoded;
}

bool SweepBuilder::is_overtaken(const PacketTiming& packet) const noexcept {
  const std::int64_t by_ns = newest_packet_ns_ - packet.first_firing_ns;
  return started_ && by_ns > 0 && by_ns <= kOvertakenByNs && !utc_changed_;
}

DecodeStatus SweepBuilder::join_late(const PacketTiming& packet, SweepPair& sweeps) noexcept {
  history_.insert(packet.first_firing_ns);
  if (!open_ || packet.first_firing_ns < sweep_start_ns_) return DecodeStatus::late;
  // It was counted as lost when it was overtaken.
  if (sweeps.current().lost_packets() > 0) --counters_.lost_packets;
  sweeps.current().recover_packet();
  return DecodeStatus::decoded;
}

bool SweepBuilder::restarts(const PacketTiming& packet) const noexcept {
  if (!packet.sequence || !newest_sequence_) return false;
  return static_cast<std::int32_t>(*packet.sequence - *newest_sequence_) <= 0;
}

std::uint32_t SweepBuilder::lost_before(const PacketTiming& packet) noexcept {
  if (!started_) return 0;
  if (packet.sequence && newest_sequence_) return *packet.sequence - *newest_sequence_ - 1;
  const std::int64_t late_ns = packet.first_firing_ns - newest_packet_ns_ - packet.duration_ns;
  if (late_ns <= packet.duration_ns / 2) return 0;
  if (is_dark_sector(late_ns, packet.turn_ns)) return 0;
  const std::int64_t count = (late_ns + packet.duration_ns / 2) / packet.duration_ns;
  return static_cast<std::uint32_t>(std::min<std::int64_t>(count, kMostLost));
}

bool SweepBuilder::is_dark_sector(std::int64_t late_ns, std::int64_t turn_ns) noexcept {
  if (late_ns < turn_ns / kDarkShareOfTurn) return false;
  const Gap gap{
      .start_ns = newest_packet_ns_, .length_ns = late_ns, .azimuth_centideg = newest_azimuth_centideg_};
  const bool known = std::ranges::any_of(gaps_, [&](const Gap& before) {
    const std::int64_t apart_ns = std::abs(gap.start_ns - before.start_ns - turn_ns);
    return apart_ns < turn_ns / 4 && same_place(before.azimuth_centideg, gap.azimuth_centideg) &&
           std::abs(gap.length_ns - before.length_ns) < gap.length_ns / 4;
  });
  gaps_[next_gap_++ % gaps_.size()] = gap;
  return known;
}

float SweepBuilder::begin_block(std::uint16_t azimuth_centideg, std::int64_t first_firing_ns,
                                SweepPair& sweeps) noexcept {
  if (!overtaken_) {
    const bool at_cut = cutter_.advance(azimuth_centideg);
    if (at_cut && open_) close(sweeps);
    if (!open_) {
      open_ = true;
      sweep_start_ns_ = first_firing_ns;
      sweeps.current().begin(clock_.to_utc_ns(first_firing_ns), at_cut && !lost_, clock_.time_source());
    }
    lost_ = false;
  }
  // Stamps jitter: a packet just after the cut may claim to be a little before it.
  const std::int64_t since_ns = std::max<std::int64_t>(0, first_firing_ns - sweep_start_ns_);
  return static_cast<float>(static_cast<double>(since_ns) * 1e-9);
}

void SweepBuilder::end_turn(SweepPair& sweeps) noexcept {
  sweeps.current().mark_partial();
  close(sweeps);
  cutter_.restart();
}

void SweepBuilder::close(SweepPair& sweeps) noexcept {
  open_ = false;
  // A packet hands over one sweep: the few blocks between a cut by time and one by azimuth are let go.
  if (has_cut_) return;
  has_cut_ = true;
  sweeps.cut();
  // Nothing of an older sweep shows until the next begins.
  sweeps.current().begin(sweeps.completed().end_utc_ns(), false, clock_.time_source());
}

bool SweepBuilder::flush(SweepPair& sweeps) noexcept {
  if (!open_ || sweeps.current().empty()) return false;
  has_cut_ = false;
  end_turn(sweeps);
  return true;
}

}  // namespace landfix::drivers
