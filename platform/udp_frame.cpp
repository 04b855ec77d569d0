#include "platform/udp_frame.hpp"

#include <algorithm>

#include "platform/big_endian.hpp"
#include "platform/internet_checksum.hpp"

namespace landfix::platform {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::uint16_t kEtherTypeIpv4 = 0x0800;
constexpr std::uint16_t kEtherTypeIpv6 = 0x86DD;
constexpr std::size_t kVlanTagBytes = 4;
constexpr std::size_t kIpv4HeaderBytes = 20;
constexpr std::size_t kIpv6HeaderBytes = 40;
constexpr std::size_t kUdpHeaderBytes = 8;

/// 802.1Q, 802.1ad, and what came before 802.1ad.
constexpr bool is_vlan(std::uint16_t ether_type) noexcept {
  return ether_type == 0x8100 || ether_type == 0x88A8 || ether_type == 0x9100;
}

struct LinkHeader {
  std::size_t bytes;
  std::size_t ether_type_offset;
};

/// Frames that do not say what they carry: the IP header's first four bits do.
constexpr bool names_protocol(LinkType link) noexcept {
  return link != LinkType::raw_ip && link != LinkType::loopback;
}

constexpr LinkHeader link_header(LinkType link) noexcept {
  switch (link) {
    case LinkType::ethernet:
      return {.bytes = 14, .ether_type_offset = 12};
    case LinkType::linux_cooked:
      return {.bytes = 16, .ether_type_offset = 14};
    case LinkType::linux_cooked2:
      return {.bytes = 20, .ether_type_offset = 0};
    case LinkType::loopback:
      return {.bytes = 4, .ether_type_offset = 0};
    case LinkType::raw_ip:
      break;
  }
  return {.bytes = 0, .ether_type_offset = 0};
}

/// Of a frame that has fewer bytes than its headers promise.
constexpr FrameStatus missing_bytes(bool cut) noexcept {
  return cut ? FrameStatus::cut_short : FrameStatus::malformed;
}

Frame refuse(FrameStatus status) noexcept { return {.status = status}; }

Frame udp_frame(Bytes bytes, std::uint32_t source_address, bool cut) noexcept {
  const std::optional<UdpDatagram> udp = parse_udp(bytes, source_address);
  if (!udp) return refuse(missing_bytes(cut));
  return {.status = FrameStatus::udp, .udp = *udp};
}

Frame parse_ipv4(Bytes bytes, bool cut) noexcept {
  if (bytes.size() < kIpv4HeaderBytes) return refuse(missing_bytes(cut));
  const std::size_t header_bytes = std::to_integer<std::size_t>(bytes[0] & std::byte{0x0F}) * 4;
  const std::size_t total_bytes = load_be16(bytes, 2);
  if (header_bytes < kIpv4HeaderBytes || total_bytes < header_bytes) return refuse(FrameStatus::malformed);
  if (std::to_integer<std::uint8_t>(bytes[9]) != kProtocolUdp) return refuse(FrameStatus::not_udp);
  if (header_bytes > bytes.size()) return refuse(missing_bytes(cut));

  // What follows the total length is Ethernet's padding. A VLP-16's position packets claim the total length
  // of its data packets, more than they have: the UDP length decides.
  const bool complete = total_bytes <= bytes.size();
  const Bytes body = bytes.first(complete ? total_bytes : bytes.size()).subspan(header_bytes);
  const std::uint32_t source_address = load_be32(bytes, 12);
  const std::uint16_t flags_and_offset = load_be16(bytes, 6);
  const bool more = (flags_and_offset & 0x2000) != 0;
  const std::size_t offset = (flags_and_offset & 0x1FFFU) * std::size_t{8};
  if (!more && offset == 0) return udp_frame(body, source_address, cut && !complete);

  if (!complete) return refuse(missing_bytes(cut));
  // All fragments but the last hold whole units of 8 bytes (RFC 791).
  if (body.empty() || (more && body.size() % 8 != 0)) return refuse(FrameStatus::malformed);
  return {.status = FrameStatus::fragment,
          .fragment = {.bytes = body,
                       .source_address = source_address,
                       .destination_address = load_be32(bytes, 16),
                       .identification = load_be16(bytes, 4),
                       .offset = offset,
                       .more = more}};
}

Frame parse_ipv6(Bytes bytes, bool cut) noexcept {
  if (bytes.size() < kIpv6HeaderBytes) return refuse(missing_bytes(cut));
  if (std::to_integer<std::uint8_t>(bytes[6]) != kProtocolUdp) return refuse(FrameStatus::not_udp);
  const std::size_t body_bytes = load_be16(bytes, 4);
  if (body_bytes > bytes.size() - kIpv6HeaderBytes) return refuse(missing_bytes(cut));
  return udp_frame(bytes.subspan(kIpv6HeaderBytes, body_bytes), 0, false);
}

Frame parse_ip(Bytes bytes, bool cut) noexcept {
  if (bytes.empty()) return refuse(missing_bytes(cut));
  switch (std::to_integer<unsigned>(bytes[0] >> 4)) {
    case 4:
      return parse_ipv4(bytes, cut);
    case 6:
      return parse_ipv6(bytes, cut);
    default:
      return refuse(FrameStatus::malformed);
  }
}

}  // namespace

std::optional<UdpDatagram> parse_udp(Bytes bytes, std::uint32_t source_address) noexcept {
  if (bytes.size() < kUdpHeaderBytes) return std::nullopt;
  const std::size_t udp_bytes = load_be16(bytes, 4);
  if (udp_bytes < kUdpHeaderBytes || udp_bytes > bytes.size()) return std::nullopt;
  return UdpDatagram{.payload = bytes.subspan(kUdpHeaderBytes, udp_bytes - kUdpHeaderBytes),
                     .source_address = source_address,
                     .source_port = load_be16(bytes, 0),
                     .destination_port = load_be16(bytes, 2)};
}

Frame parse_frame(LinkType link, Bytes captured, std::size_t wire_bytes) noexcept {
  const bool cut = captured.size() < wire_bytes;
  const LinkHeader header = link_header(link);
  if (captured.size() < header.bytes) return refuse(missing_bytes(cut));
  Bytes rest = captured.subspan(header.bytes);
  if (!names_protocol(link)) return parse_ip(rest, cut);

  std::uint16_t ether_type = load_be16(captured, header.ether_type_offset);
  while (is_vlan(ether_type)) {
    if (rest.size() < kVlanTagBytes) return refuse(missing_bytes(cut));
    ether_type = load_be16(rest, 2);
    rest = rest.subspan(kVlanTagBytes);
  }
  if (ether_type != kEtherTypeIpv4 && ether_type != kEtherTypeIpv6) return refuse(FrameStatus::not_ip);
  return parse_ip(rest, cut);
}

}  // namespace landfix::platform
