#include "drivers/sweep_builder.hpp"

#include <cstdlib>

namespace landfix::drivers {
namespace {

/// The last packet before a dark sector begins up to its own span, at most 10 deg, before the sector.
constexpr int kSamePlaceCentideg = 1000;

bool same_place(int a_centideg, int b_centideg) noexcept {
  const int apart = std::abs(a_centideg - b_centideg);
  return apart < kSamePlaceCentideg || apart > kTurnCentideg - kSamePlaceCentideg;
}

}  // namespace

bool SweepBuilder::follows_a_loss(const PacketTiming& packet) noexcept {
  if (!started_) return false;
  if (packet.sequence && last_sequence_) return *packet.sequence != *last_sequence_ + 1;
  const std::int64_t late_ns = packet.first_firing_ns - last_packet_ns_ - packet.duration_ns;
  if (std::abs(late_ns) <= packet.duration_ns / 2) return false;
  // A restricted field of view sends nothing over the same sector in every turn; a loss may be anywhere.
  const bool known = dark_from_centideg_ && same_place(*dark_from_centideg_, last_azimuth_centideg_);
  dark_from_centideg_ = last_azimuth_centideg_;
  return !known;
}

DecodeStatus SweepBuilder::begin_packet(const PacketTiming& packet, std::uint16_t first_azimuth_centideg,
                                        SweepPair& sweeps) noexcept {
  has_cut_ = false;
  const bool jumped = clock_.advance(packet.first_firing_ns, packet.receive_utc_ns);
  lost_ = follows_a_loss(packet) || jumped;
  if (open_) {
    if (lost_) sweeps.current().mark_partial();
    const std::int64_t elapsed_ns = packet.first_firing_ns - sweep_start_ns_;
    if (jumped || elapsed_ns < 0 || elapsed_ns > packet.turn_ns + packet.turn_ns / 2) {
      sweeps.current().mark_partial();
      close(sweeps);
      cutter_.restart();
    }
  }
  started_ = true;
  last_packet_ns_ = packet.first_firing_ns;
  last_sequence_ = packet.sequence;
  last_azimuth_centideg_ = first_azimuth_centideg;
  return DecodeStatus::decoded;
}

float SweepBuilder::begin_block(std::uint16_t azimuth_centideg, std::int64_t first_firing_ns,
                                SweepPair& sweeps) noexcept {
  const bool at_cut = cutter_.advance(azimuth_centideg);
  if (at_cut && open_) close(sweeps);
  if (!open_) {
    open_ = true;
    sweep_start_ns_ = first_firing_ns;
    sweeps.current().begin(clock_.to_utc_ns(first_firing_ns), at_cut && !lost_, clock_.time_source());
  }
  lost_ = false;
  return static_cast<float>(static_cast<double>(first_firing_ns - sweep_start_ns_) * 1e-9);
}

void SweepBuilder::close(SweepPair& sweeps) noexcept {
  open_ = false;
  // A packet hands over one sweep: the few blocks between a cut by time and one by azimuth are let go.
  if (has_cut_) return;
  has_cut_ = true;
  sweeps.cut();
}

bool SweepBuilder::flush(SweepPair& sweeps) noexcept {
  if (!open_ || sweeps.current().points().empty()) return false;
  has_cut_ = false;
  sweeps.current().mark_partial();
  close(sweeps);
  cutter_.restart();
  return true;
}

}  // namespace landfix::drivers
