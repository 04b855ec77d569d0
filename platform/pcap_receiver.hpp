// A capture in place of the network: its packets at the pace at which they came, or as fast as they are
// taken.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "platform/packet_receiver.hpp"
#include "platform/pcap_source.hpp"

namespace landfix::platform {

struct PcapReceiverSettings {
  std::filesystem::path file{};
  std::vector<std::uint16_t> ports{};  ///< the others' packets are counted and left out; empty: all are kept
  std::uint32_t sensor_address = 0;    ///< IPv4, host byte order; 0: whoever sends
  double speed = 1.0;      ///< recorded time over real time; 0: never waits but for room in the ring
  std::uint64_t laps = 1;  ///< how often the capture is run through
};

/// At a pace, a packet for which the ring has no room is dropped and counted, as a socket's would be; without
/// one it waits. Reading does not allocate, but as PcapSource says, and that a pcapng file is opened anew
/// each lap.
class PcapReceiver final : public PacketReceiver {
 public:
  /// Throws std::runtime_error, as PcapSource does.
  explicit PcapReceiver(PcapReceiverSettings settings);

  [[nodiscard]] ReceiveStatus receive(PacketRing& ring, std::int64_t deadline_mono_ns) noexcept override;
  [[nodiscard]] const ReceiveCounters& counters() const noexcept override { return counters_; }

  /// For use between calls of `receive`, by the thread that makes them.
  [[nodiscard]] const PcapSource& source() const noexcept { return source_; }
  [[nodiscard]] std::uint64_t laps_done() const noexcept { return laps_done_; }

 private:
  [[nodiscard]] ReadStatus next() noexcept;
  [[nodiscard]] bool begin_lap() noexcept;
  [[nodiscard]] bool is_kept(const UdpPacket& packet) noexcept;
  [[nodiscard]] std::int64_t due_mono_ns() const noexcept;
  [[nodiscard]] bool wait_for_pending(std::int64_t deadline_mono_ns) noexcept;
  void put(PacketRing& ring, std::size_t slot) noexcept;

  PcapReceiverSettings settings_;
  PcapSource source_;
  UdpPacket pending_;  ///< read, and not yet in the ring
  bool has_pending_ = false;
  std::int64_t began_mono_ns_ = 0;  ///< when the capture's first packet was due
  std::int64_t first_utc_ns_ = 0;   ///< its stamp
  std::int64_t last_utc_ns_ = 0;
  std::uint64_t packets_in_lap_ = 0;
  std::int64_t shift_ns_ = 0;  ///< of this lap's stamps
  std::uint64_t laps_done_ = 0;
  alignas(64) ReceiveCounters counters_;  // which others read
};

}  // namespace landfix::platform
