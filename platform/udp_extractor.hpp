// Frames in, UDP datagrams out, and a count of everything that was not one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "platform/ip_reassembly.hpp"
#include "platform/udp_frame.hpp"

namespace landfix::platform {

/// Every record is counted once, as udp, not_ip, not_udp, malformed, cut_short or fragments.
struct CaptureCounters {
  std::uint64_t records = 0;
  std::uint64_t udp = 0;        ///< datagrams that came whole
  std::uint64_t not_ip = 0;     ///< ARP, LLDP, PTP over Ethernet, ...
  std::uint64_t not_udp = 0;    ///< TCP, ICMP, ...
  std::uint64_t malformed = 0;  ///< a header, a length or a time stamp does not fit
  std::uint64_t cut_short = 0;  ///< the capture's snapshot length was too small
  std::uint64_t fragments = 0;
  std::uint64_t reassembled = 0;          ///< datagrams put together from fragments
  std::uint64_t fragments_duplicate = 0;  ///< fragments that came twice
  std::uint64_t fragments_dropped = 0;    ///< fragments of datagrams that were never complete
};

/// More than 1 MiB: keep it on the heap, or static.
class UdpExtractor {
 public:
  /// The datagram in this frame, or the one that it completes, valid until the next call.
  [[nodiscard]] std::optional<UdpDatagram> extract(LinkType link, std::span<const std::byte> captured,
                                                   std::size_t wire_bytes,
                                                   std::int64_t stamp_utc_ns) noexcept;

  /// A record that is refused before its bytes are looked at.
  void count_malformed() noexcept;

  /// No more frames: fragments that still wait are dropped.
  void finish() noexcept { reassembly_.clear(); }

  /// As new.
  void reset() noexcept {
    reassembly_.reset();
    counters_ = {};
  }

  [[nodiscard]] CaptureCounters counters() const noexcept;

 private:
  IpReassembly reassembly_;
  CaptureCounters counters_;
};

}  // namespace landfix::platform
