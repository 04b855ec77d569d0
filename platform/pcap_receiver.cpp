#include "platform/pcap_receiver.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "platform/monotonic_clock.hpp"
#include "platform/pace.hpp"
#include "platform/sleep_until.hpp"

namespace landfix::platform {
namespace {

constexpr std::size_t kBatch = 32;
constexpr std::int64_t kPoll_ns = 100'000;  // between looks for room in the ring

}  // namespace

PcapReceiver::PcapReceiver(PcapReceiverSettings settings)
    : settings_(std::move(settings)), source_(settings_.file) {}

ReceiveStatus PcapReceiver::receive(PacketRing& ring, std::int64_t deadline_mono_ns) noexcept {
  const bool is_paced = settings_.speed > 0.0;
  std::size_t filled = 0;
  auto status = ReadStatus::packet;
  for (std::size_t i = 0; i < kBatch && (status = next()) == ReadStatus::packet; ++i) {
    // What is in hand goes out before any waiting.
    if (is_paced && !wait_for_pending(filled != 0 ? 0 : deadline_mono_ns)) break;
    const bool has_room = ring.free_slots(filled + 1) > filled;
    if (pending_.payload.size() > ring.slot_bytes()) {
      ++counters_.truncated;
    } else if (has_room) {
      put(ring, filled++);
    } else if (is_paced) {
      ++counters_.dropped_ring_full;
    } else {
      if (filled == 0) sleep_until(std::min(monotonic_ns() + kPoll_ns, deadline_mono_ns));
      break;
    }
    has_pending_ = false;
  }
  ring.publish(filled);
  if (filled != 0) return ReceiveStatus::packets;
  if (status == ReadStatus::packet) return ReceiveStatus::nothing;
  return status == ReadStatus::end ? ReceiveStatus::end : ReceiveStatus::truncated;
}

/// Makes sure of a packet in pending_.
ReadStatus PcapReceiver::next() noexcept {
  while (!has_pending_) {
    const ReadStatus status = source_.next(pending_);
    if (status == ReadStatus::packet) {
      has_pending_ = is_kept(pending_);
      continue;
    }
    // A capture that is cut off has lost its end in every lap.
    if (laps_done_ < settings_.laps) ++laps_done_;
    if (laps_done_ == settings_.laps || packets_in_lap_ == 0 || !begin_lap()) return status;
  }
  return ReadStatus::packet;
}

/// One mean interval after the last packet the first comes again.
bool PcapReceiver::begin_lap() noexcept {
  const std::int64_t lasted_ns = last_utc_ns_ - first_utc_ns_;
  const auto intervals = static_cast<std::int64_t>(packets_in_lap_) - 1;
  const std::int64_t interval_ns = intervals == 0 ? 0 : lasted_ns / intervals;
  const std::int64_t left_ns = std::numeric_limits<std::int64_t>::max() - last_utc_ns_ - shift_ns_;
  if (interval_ns > left_ns - lasted_ns) return false;  // the end of time, as 64 bits count it
  shift_ns_ += lasted_ns + interval_ns;
  packets_in_lap_ = 0;
  return source_.restart();
}

bool PcapReceiver::is_kept(const UdpPacket& packet) noexcept {
  if (settings_.sensor_address != 0 && packet.source_address != settings_.sensor_address) {
    ++counters_.strangers;
    return false;
  }
  const auto& ports = settings_.ports;
  if (!ports.empty() && std::find(ports.begin(), ports.end(), packet.destination_port) == ports.end()) {
    ++counters_.other_ports;
    return false;
  }
  if (packets_in_lap_++ == 0 && laps_done_ == 0) {
    first_utc_ns_ = packet.receive_utc_ns;
    last_utc_ns_ = first_utc_ns_;
    began_mono_ns_ = monotonic_ns();
  }
  last_utc_ns_ = std::max(last_utc_ns_, packet.receive_utc_ns);
  return true;
}

std::int64_t PcapReceiver::due_mono_ns() const noexcept {
  return began_mono_ns_ + paced_ns(pending_.receive_utc_ns + shift_ns_ - first_utc_ns_, settings_.speed);
}

/// Whether the packet is due, at the latest at the deadline.
bool PcapReceiver::wait_for_pending(std::int64_t deadline_mono_ns) noexcept {
  const std::int64_t due_ns = due_mono_ns();
  if (due_ns <= monotonic_ns()) return true;
  if (deadline_mono_ns > 0) sleep_until(std::min(due_ns, deadline_mono_ns));
  return due_ns <= monotonic_ns();
}

void PcapReceiver::put(PacketRing& ring, std::size_t slot) noexcept {
  std::ranges::copy(pending_.payload, ring.room(slot).begin());
  const std::int64_t taken_mono_ns = monotonic_ns();
  ring.header_to_fill(slot) = {
      .receive_utc_ns = pending_.receive_utc_ns + shift_ns_,
      .arrived_mono_ns = settings_.speed > 0.0 ? due_mono_ns() : taken_mono_ns,
      .taken_mono_ns = taken_mono_ns,
      .source_address = pending_.source_address,
      .source_port = pending_.source_port,
      .destination_port = pending_.destination_port,
      .size = static_cast<std::uint32_t>(pending_.payload.size()),
  };
  ++counters_.packets;
  counters_.bytes += pending_.payload.size();
}

}  // namespace landfix::platform
