// A capture back onto the network: its UDP payloads at the times at which they came.
#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "platform/file_descriptor.hpp"
#include "platform/packet_ring.hpp"
#include "platform/pcap_receiver.hpp"

namespace landfix::platform {

/// Addresses are IPv4, in host byte order.
struct PlaySettings {
  std::filesystem::path file{};
  std::uint32_t to_address = 0;                    ///< of one computer, a broadcast or a multicast group
  std::uint32_t from_address = 0;                  ///< of this computer; 0: the recorded one if it has it
  std::map<std::uint16_t, std::uint16_t> ports{};  ///< recorded to sent; those that it lacks are kept
  int multicast_hops = 1;                          ///< routers that a multicast may pass, and one
  double speed = 1.0;                              ///< recorded time over real time; 0: as fast as it goes
  std::uint64_t laps = 1;
};

struct PlayCounters {
  std::uint64_t packets = 0;
  std::uint64_t bytes = 0;           ///< of payload
  std::uint64_t not_sent = 0;        ///< the interface's queue was full
  std::int64_t late_at_most_ns = 0;  ///< behind its time
  std::int64_t lasted_ns = 0;
};

class CapturePlayer {
 public:
  /// Throws std::runtime_error where the capture cannot be read or the address not be sent from.
  explicit CapturePlayer(const PlaySettings& settings);

  /// Sends what is due, waiting for it a fifth of a second at the longest. False at the end. Throws
  /// std::runtime_error where the system refuses to send.
  bool play_some();

  [[nodiscard]] const PlayCounters& counters() const noexcept { return counters_; }
  [[nodiscard]] double percent_of_lap() const noexcept { return receiver_.source().percent_read(); }
  /// Why the capture ended before its end, else empty.
  [[nodiscard]] const char* read_error() const noexcept { return receiver_.source().read_error(); }

 private:
  void send_all(std::size_t count);

  std::map<std::uint16_t, std::uint16_t> ports_;
  std::uint32_t to_address_;
  FileDescriptor socket_;
  PcapReceiver receiver_;
  PacketRing ring_;  ///< what is due
  std::int64_t began_mono_ns_;
  PlayCounters counters_;
};

/// The recorded port to which most bytes were sent, a sensor's data. Throws as PcapSource does, and where the
/// capture has no UDP packet.
[[nodiscard]] std::uint16_t busiest_port(const std::filesystem::path& file);

}  // namespace landfix::platform
