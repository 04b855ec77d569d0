// From the bytes of a link-layer frame to the UDP datagram or the IP fragment that it carries. Nothing in the
// frame is trusted: a length that does not fit refuses the frame, with the reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace landfix::platform {

/// What precedes the IP header.
enum class LinkType : std::uint8_t {
  ethernet,       ///< with any number of VLAN tags
  linux_cooked,   ///< LINKTYPE_LINUX_SLL, of captures on the interface "any"
  linux_cooked2,  ///< LINKTYPE_LINUX_SLL2
  raw_ip,         ///< nothing
  loopback,       ///< LINKTYPE_NULL and LINKTYPE_LOOP of the BSDs: four bytes of address family
};

/// Spans point into the frame.
struct UdpDatagram {
  std::span<const std::byte> payload;
  std::uint32_t source_address = 0;  ///< IPv4, host byte order; 0 for IPv6
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
};

/// A piece of a UDP datagram that IPv4 had to split.
struct IpFragment {
  std::span<const std::byte> bytes;
  std::uint32_t source_address = 0;       ///< host byte order
  std::uint32_t destination_address = 0;  ///< host byte order
  std::uint16_t identification = 0;       ///< the same in all fragments of a datagram
  std::size_t offset = 0;                 ///< of `bytes` in the datagram, a multiple of 8
  bool more = false;                      ///< this is not the last one
};

/// What a frame turned out to be.
enum class FrameStatus : std::uint8_t {
  udp,        ///< `Frame::udp` holds it
  fragment,   ///< `Frame::fragment` holds it
  not_ip,     ///< ARP, LLDP, PTP over Ethernet, ...
  not_udp,    ///< TCP, ICMP, ..., and UDP behind IPv6 extension headers
  malformed,  ///< a header or a length does not fit
  cut_short,  ///< the capture did not keep all bytes of the frame (its snapshot length)
};

struct Frame {
  FrameStatus status = FrameStatus::malformed;
  UdpDatagram udp{};
  IpFragment fragment{};
};

/// `captured`: the bytes at hand; `wire_bytes`: the length of the frame when it was on the wire.
/// Checksums are not looked at: a capture on the sending machine sees them before the network card fills them
/// in.
[[nodiscard]] Frame parse_frame(LinkType link, std::span<const std::byte> captured,
                                std::size_t wire_bytes) noexcept;

/// `bytes`: UDP header and payload, maybe with padding behind; nothing if the header does not fit them.
[[nodiscard]] std::optional<UdpDatagram> parse_udp(std::span<const std::byte> bytes,
                                                   std::uint32_t source_address) noexcept;

}  // namespace landfix::platform
